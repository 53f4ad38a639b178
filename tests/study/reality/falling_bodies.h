#pragma once

#include <memory>
#include <optional>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

// Fluid bodies about the origin of their meshes. A missing added mass is solved for.

std::shared_ptr<const FluidBody> sheetOf(const TriangleMesh& mesh,
                                         const std::optional<Matrix6>& added_mass = {});
std::shared_ptr<const FluidBody> solidOf(const TriangleMesh& mesh,
                                         const std::optional<Matrix6>& added_mass = {});
std::shared_ptr<const FluidBody> ballOf(double radius);

// Added masses per unit density, axes of the shapes along x, y, z.

Matrix6 addedMassOfEllipsoid(const Vector3& semi_axes);
Matrix6 addedMassOfDisc(double radius);
/// Elliptic cylinder of chord, span and thickness (x, y, z), flow in the x-z plane.
Matrix6 addedMassOfStrip(const Vector3& size);

/// Moments of inertia about the principal axes x, y, z [kg m^2].
Vector3 inertiaOfBox(double mass, const Vector3& size);

}  // namespace ambient
