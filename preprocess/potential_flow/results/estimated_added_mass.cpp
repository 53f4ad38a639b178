#include "preprocess/potential_flow/results/estimated_added_mass.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

namespace ambient {
namespace {

// Rotational added mass due to edges and corners, over lack of volume times the rotational inertia
// of the ellipsoid full of fluid; fitted to the cube.
constexpr double kCorners = 0.33;
// Largest lack of volume, ellipsoid's over body's minus 1, that is corrected for: that of a box.
// The ellipsoid says little about bodies that lack more.
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

std::vector<AddedMassPart> estimateParts(TriangleMesh mesh, const Matrix6& added_mass) {
  const Vector3 centre = computeMassProperties(mesh).uniform.centre;
  mesh.vertices.colwise() -= centre;
  const Matrix6 about_centre = shiftOrigin(added_mass, centre);
  return placed(joinPanels(simplePanels(mesh, about_centre.diagonal())), 1, centre);
}

}  // namespace ambient
