#include "bullet_ambient/motion/surface_model.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bullet_ambient/force/load_tables.h"
#include "bullet_ambient/force/surface_loads.h"
#include "bullet_ambient/spatial/positive_inverse.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

double radiusOf(const FluidBody& body, const FrameOffset& frame) {
  if (body.sphere_radius > 0)
    return body.sphere_radius + (frame.rotation * body.centre_of_volume + frame.translation).norm();
  double largest = 0;
  const std::vector<double>& v = body.surface.vertices;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
    const Vector3 place = frame.rotation * Vector3(v[i], v[i + 1], v[i + 2]) + frame.translation;
    largest = std::max(largest, place.norm());
  }
  return largest;
}

void checkSurfaceBody(const SurfaceModelDef& def) {
  const FluidBody& body = *def.shape;
  if (!(def.above.density <= def.below.density))
    reject(body, "density of the fluid above it [kg/m^3]", def.above.density,
           "at most that of the fluid below");
  if (!(def.wave_damping >= 0) || !std::isfinite(def.wave_damping))
    reject(body, "wave damping", def.wave_damping, "zero or positive and finite");
  if (body.surface.triangles.empty() && !(body.sphere_radius > 0))
    reject(body, "number of triangles of its surface", 0, "positive for a body that may float");
}

PartLoads partLoads(const SurfaceModelDef& def, const Medium& medium, LoadTables& tables) {
  PartLoads part{makeWaterlineLoads(def.shape, medium, def.flow, tables), {}};
  if (part.loads) part.frame = part.loads->frame(def.fluid_frame);
  return part;
}

bool isFeltAbove(const SurfaceModelDef& def) {
  constexpr double kLittle = 0.01;
  return def.above.density >= kLittle * def.below.density || !def.above.velocity.isZero(0);
}

}  // namespace

SurfaceModel makeSurfaceModel(const SurfaceModelDef& def, LoadTables& tables) {
  checkSurfaceBody(def);
  const auto modelIn = [&](const Medium& medium) {
    return makeBodyModel(*def.shape, def.fluid_frame, def.mass, medium,
                         makeSurfaceLoads(def.shape, medium, def.flow, tables));
  };
  SurfaceModel model;
  model.above = modelIn(def.above);
  model.below = modelIn(def.below);
  model.fluid_frame = def.fluid_frame;
  model.excess_density = def.below.density - def.above.density;
  model.shape = def.shape;
  if (!(def.shape->sphere_radius > 0)) model.hull = tables.hull(def.shape);
  model.wetted = makeWettedInertia(def.shape, tables);
  model.loads_below = partLoads(def, def.below, tables);
  if (isFeltAbove(def)) model.loads_above = partLoads(def, def.above, tables);
  model.radius = radiusOf(*def.shape, def.fluid_frame);
  constexpr double kHeaveOfParts = 1.13;
  if (model.hull && def.shape->waterline.empty()) model.heave_factor = kHeaveOfParts;
  model.wave_damping = def.wave_damping;
  return model;
}

namespace {

Immersion withExtent(const SurfaceModel& model, const SurfacePlane& plane_F) noexcept {
  Immersion immersion{plane_F, 0, 0, {}};
  if (model.hull) {
    std::tie(immersion.low, immersion.high) = computeExtent(*model.hull, plane_F.normal);
  } else {
    const double middle = plane_F.normal.dot(model.shape->centre_of_volume);
    immersion.low = middle - model.shape->sphere_radius;
    immersion.high = middle + model.shape->sphere_radius;
  }
  return immersion;
}

}  // namespace

SurfaceSide sideOf(const SurfaceModel& model, const SurfacePlane& plane_B, double travel) noexcept {
  const double height = plane_B.height, radius = model.radius;
  if (height < -radius - travel) return SurfaceSide::kAbove;
  if (height > 5 * radius + travel) return SurfaceSide::kBelow;  // covered by twice its diameter
  const Immersion at = withExtent(model, seenFrom(plane_B, model.fluid_frame));
  if (at.draught() + travel <= 0) return SurfaceSide::kAbove;
  return at.cover() - travel >= 2 * at.size() ? SurfaceSide::kBelow : SurfaceSide::kAt;
}

Immersion immersionOf(const SurfaceModel& model, const SurfacePlane& plane_B) noexcept {
  const SurfacePlane plane = seenFrom(plane_B, model.fluid_frame);
  Immersion immersion = withExtent(model, plane);
  if (model.hull) {
    immersion.wet = computeWetVolume(*model.hull, plane);
  } else {
    immersion.wet =
        computeWetSphere(model.shape->sphere_radius, model.shape->centre_of_volume, plane);
  }
  return immersion;
}

namespace {

Matrix6 withoutNegativePart(const Matrix6& K) {
  const auto eigen = symmetricEigen<6>(K);
  return eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() * eigen.vectors.transpose();
}

// In B.
Matrix6 wettedInertiaAt(const SurfaceModel& model, const Immersion& immersion) {
  const Matrix6 in_F = model.wetted->inertia(immersion);
  if (model.fluid_frame.isIdentity()) return in_F;
  const Matrix6 in_B = model.fluid_frame.inertiaToB(in_F);
  return 0.5 * (in_B + in_B.transpose());
}

}  // namespace

TotalInertia inertiaAt(const SurfaceModel& model, const Immersion& immersion) noexcept {
  const Matrix6 wet = wettedInertiaAt(model, immersion);
  const Matrix6 K = model.above.inertia + model.excess_density * wet;
  if (const auto inverse = positiveInverse(K)) return {K, *inverse};
  const Matrix6 positive = model.above.inertia + model.excess_density * withoutNegativePart(wet);
  return {positive, positiveInverse(positive).value_or(model.above.inverse_inertia)};
}

}  // namespace ambient
