#include "preprocess/potential_flow/estimated_added_mass.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/pi.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "preprocess/potential_flow/ellipsoid_added_mass.h"

namespace ambient {
namespace {

// Of the rotational inertia of the ellipsoid full of fluid, for corners and edges: so that the
// cube's is right.
constexpr double kCorners = 0.33;
// That of a box. Of a body that lacks more, the ellipsoid says little.
constexpr double kMostLack = 0.13;

}  // namespace

EquivalentEllipsoid equivalentEllipsoid(const MeshProperties& properties) {
  const PrincipalFrame frame = findPrincipalFrame(properties.uniform.inertia);
  // A solid ellipsoid has moments of (b^2 + c^2) / 5 per unit mass.
  Vector3 squares = 2.5 * (Vector3::Constant(frame.moments.sum()) - 2 * frame.moments);
  squares = squares.cwiseMax(1e-12 * squares.maxCoeff());
  const Vector3 semi_axes = squares.cwiseSqrt();
  const double volume = 4 * kPi / 3 * semi_axes.prod();
  EquivalentEllipsoid result;
  result.fullness = properties.volume / volume;
  const double lack = std::clamp(1 / result.fullness - 1, 0.0, kMostLack);
  Vector6 diagonal = ellipsoidAddedMass(semi_axes);
  diagonal.tail<3>() *= 1 + lack;
  diagonal.head<3>() += kCorners * lack * volume * (Vector3::Constant(squares.sum()) - squares);
  const Matrix6 about_centre = rotateAxes(Matrix6(diagonal.asDiagonal()), frame.rotation);
  result.added_mass = shiftOrigin(about_centre, -properties.uniform.centre);
  return result;
}

}  // namespace ambient
