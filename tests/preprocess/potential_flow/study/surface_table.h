#pragma once

#include <string>

#include "bullet_ambient/spatial/vector_types.h"
#include "tests/preprocess/potential_flow/study/surface_cases.h"

namespace ambient::study {

/// Total inertia of body and water in F [kg, m], at a plane in F, by the image: the body's own and
/// solveImageFlow() on so many panels.
Matrix6 imageInertia(const SurfaceCase& body, const SurfacePlane& plane, int panels);

/// Largest |x.K x / x.K_ref x - 1| over all motions x, rotations among them; does not depend on
/// the origin. @pre the reference is positive definite
double largestError(const Matrix6& inertia, const Matrix6& reference);

/// The height of the plane along `normal` at which half of the volume is in the water [m].
double floatingHeight(const SurfaceModel& model, const Vector3& normal);

/// The wetted inertia of the runtime against the image, as Markdown: errors of the total inertia
/// over `poses` random attitudes of each shape, afloat and at random depths, without a waterline
/// table and with one of so many subdivisions.
std::string surfaceTable(int poses, int panels, int subdivisions);

}  // namespace ambient::study
