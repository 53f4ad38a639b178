#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/added_mass_parts.h"

namespace ambient {

/// Added mass of an ellipsoid about its centre, per unit density: diagonal in its axes, rotation
/// first. Semi-axes [m]. Closed form of Lamb, Hydrodynamics, 6th ed., art. 114 and 115, its
/// integrals by Carlson's duplication (1979), to rounding.
/// @pre semi-axes positive and finite
Vector6 ellipsoidAddedMass(const Vector3& semi_axes);

/// What the triangles of its mesh, about its centre, contribute: its potentials are linear in
/// translation and bilinear in rotation (art. 114, 115).
std::vector<PanelInertia> ellipsoidPanels(const TriangleMesh& mesh, const Vector3& semi_axes);

/// The same of any body about its centre, as if its potentials in translation were as linear as an
/// ellipsoid's; none in rotation. Their sum in translation is the volume times `per_volume`.
std::vector<PanelInertia> linearPanels(const TriangleMesh& mesh, const Vector3& per_volume);

}  // namespace ambient
