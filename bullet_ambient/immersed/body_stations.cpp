#include "bullet_ambient/immersed/body_stations.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/principal_frame.h"

AMBIENT_BEGIN

BodyStations makeBodyStations(const AttachDef& def) {
  constexpr double kShort = 0.2;  // length relative to the longest axis
  const FluidBody& shape = *def.fluid_body;
  const Matrix3& inertia =
      shape.volume > 0 ? shape.uniform_mass.inertia : shape.surface_mass.inertia;
  BodyStations stations;
  if (!inertia.allFinite() || !(inertia.trace() > 0)) return stations;
  const PrincipalFrame principal = findPrincipalFrame((inertia + inertia.transpose()) / 2);
  // Mean square distance along each axis: half the trace less the moment about the axis.
  const Vector3 squares =
      (Vector3::Constant(principal.moments.sum() / 2) - principal.moments).cwiseMax(0);
  const Vector3 lengths = (12 * squares).cwiseSqrt();
  const Matrix3 axes_B = def.fluid_frame.rotation * principal.rotation;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(lengths[axis] > kShort * lengths.maxCoeff())) continue;
    stations.lengths[axis] = lengths[axis];
    const double way = std::sqrt(0.6) / 2 * lengths[axis];
    stations.ways_B.col(axis) = way * axes_B.col(axis);
    stations.reach = std::max(stations.reach, way);
  }
  return stations;
}

AMBIENT_END
