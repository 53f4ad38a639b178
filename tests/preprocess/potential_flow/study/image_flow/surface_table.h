#pragma once

#include <string>

#include "bullet_ambient/spatial/vector_types.h"
#include "tests/preprocess/potential_flow/study/image_flow/surface_cases.h"

namespace ambient::study {

/// Total inertia of body and water in F [kg, m], with a plane in F, by the image method: body's
/// inertia plus solveImageFlow() with `panels`.
Matrix6 imageInertia(const SurfaceCase& body, const SurfacePlane& plane, int panels);

/// Largest |x.K x / x.K_ref x - 1| over all motions x, including rotations; independent of the
/// origin. @pre the reference is positive definite
double largestError(const Matrix6& inertia, const Matrix6& reference);

/// Height of the plane along `normal` with half of the volume under water [m].
double floatingHeight(const SurfaceModel& model, const Vector3& normal);

/// Markdown: errors of the runtime's wetted inertia against the image method, as total inertia.
/// `poses` random attitudes of each shape, afloat and at random depths. Without waterline table,
/// and with a table of `subdivisions`.
std::string surfaceTable(int poses, int panels, int subdivisions);

}  // namespace ambient::study
