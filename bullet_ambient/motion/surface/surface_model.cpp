#include "bullet_ambient/motion/surface/surface_model.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/loads/foils.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

/// Distance of the farthest corner from the centre of mass, or of the farthest point of a sphere.
double radiusOf(const FluidBody& body, const FrameOffset& frame, const PackedHull* hull) {
  if (!hull)
    return body.sphere_radius + (frame.rotation * body.centre_of_volume + frame.translation).norm();
  const Vector3 middle = -(frame.rotation.transpose() * frame.translation);
  const HullCorners corners = hull->corners();
  double largest = 0;
  for (int image = 0; image < corners.symmetry.images(); ++image) {
    const Vector3 seen = corners.symmetry.seenFrom(middle, image);
    for (std::size_t i = 0; i < corners.count; ++i) {
      const auto& place = corners.blocks[i].place;
      for (int k = 0; k < HullPoints::kPoints; ++k)
        largest = std::max(largest, (Vector3(place[0][k], place[1][k], place[2][k]) - seen).norm());
    }
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

PartLoads partLoads(const SurfaceModelDef& def, const Medium& medium) {
  PartLoads part{makeWaterlineLoads(def.shape, medium, def.flow), {}, nullptr};
  if (!part.loads) return part;
  part.frame = part.loads->frame(def.fluid_frame);
  part.resistance = resistanceInB(part.loads, part.frame, def.load_factor);
  return part;
}

bool isFeltAbove(const SurfaceModelDef& def) {
  constexpr double kLittle = 0.01;
  return def.above.density >= kLittle * def.below.density || !def.above.velocity.isZero(0);
}

WetVolume wetVolumeInF(const SurfaceModel& model, const SurfacePlane& plane_F) {
  if (model.hull) return computeWetVolume(*model.hull, plane_F);
  return computeWetSphere(model.shape->sphere_radius, model.shape->centre_of_volume, plane_F);
}

}  // namespace

SurfaceModel makeSurfaceModel(const SurfaceModelDef& def) {
  checkSurfaceBody(def);
  const auto modelIn = [&](const Medium& medium, HoldContent content) {
    return makeBodyModel(*def.shape, def.fluid_frame, def.mass, medium,
                         makeSurfaceLoads(def.shape, medium, def.flow),
                         {content, def.added_mass_factor, def.load_factor});
  };
  SurfaceModel model;
  model.above = modelIn(def.above, HoldContent::kFull);
  model.below = modelIn(def.below, HoldContent::kSealed);
  model.fluid_frame = def.fluid_frame;
  model.excess_density = def.below.density - def.above.density;
  model.added_density = def.added_mass_factor * model.excess_density;
  model.load_factor = def.load_factor;
  model.shape = def.shape;
  if (!(def.shape->sphere_radius > 0)) model.hull = LoadTables(def.shape).hull();
  if (!def.shape->holds.empty()) model.holds = std::make_shared<HoldShapes>(def.shape->holds);
  model.wetted = makeWettedInertia(def.shape);
  model.loads_below = partLoads(def, def.below);
  if (isFeltAbove(def)) model.loads_above = partLoads(def, def.above);
  model.radius = radiusOf(*def.shape, def.fluid_frame, model.hull.get());
  if (def.flow.foils)
    model.radius =
        std::max(model.radius, def.flow.foils->reachFrom(-(def.fluid_frame.rotation.transpose() *
                                                           def.fluid_frame.translation)));
  constexpr double kHeaveOfParts = 1.13;
  if (model.hull && def.shape->waterline.empty()) model.heave_factor = kHeaveOfParts;
  model.wave_damping = def.wave_damping;
  model.still_axis_B = stillAxisOf(model, def.mass);
  AMBIENT_ASSERT(model.wetted && (model.hull || def.shape->sphere_radius > 0));
  AMBIENT_ASSERT(model.excess_density >= 0 && model.radius >= 0 && std::isfinite(model.radius));
  return model;
}

Vector3 stillAxisOf(const SurfaceModel& model, const MassProperties& mass) {
  constexpr double kRound = 1e-3;  // of the moments, and of the radius of inertia
  if (model.holds) return Vector3::Zero();
  const Vector3 axis = model.fluid_frame.rotation * axisOfRevolution(*model.shape);
  const Matrix3 along = axis * axis.transpose();
  const double moment = axis.dot(mass.inertia * axis);
  const double across = (mass.inertia.trace() - moment) / 2;
  const Matrix3 round = moment * along + across * (Matrix3::Identity() - along);
  const Vector3 centre = model.above.centre_of_volume;
  const double aside_sq = (centre - along * centre).squaredNorm();
  const bool is_round = (mass.inertia - round).norm() < kRound * across &&
                        mass.mass * aside_sq < kRound * kRound * across;
  return is_round ? axis : Vector3::Zero();
}

namespace {

Immersion withExtent(const SurfaceModel& model, const SurfacePlane& plane_F) noexcept {
  Immersion immersion{plane_F, 0, 0, {}};
  AMBIENT_ASSERT(isUnit(plane_F.normal));
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
  AMBIENT_ASSERT(!(travel < 0));
  const double height = plane_B.height, radius = model.radius;
  if (height < -radius - travel) return SurfaceSide::kAbove;
  if (height > 5 * radius + travel) return SurfaceSide::kBelow;  // covered by twice its diameter
  const Immersion at = withExtent(model, seenFrom(plane_B, model.fluid_frame));
  if (at.draught() + travel <= 0) return SurfaceSide::kAbove;
  return at.submergence() - travel >= 2 * at.size() ? SurfaceSide::kBelow : SurfaceSide::kAt;
}

Immersion immersionOf(const SurfaceModel& model, const SurfacePlane& plane_B) noexcept {
  const SurfacePlane plane = seenFrom(plane_B, model.fluid_frame);
  Immersion immersion = withExtent(model, plane);
  immersion.wet = wetVolumeInF(model, plane);
  return immersion;
}

WetVolume wetVolumeAt(const SurfaceModel& model, const SurfacePlane& plane_B,
                      const HoldState* water) noexcept {
  const FrameOffset& frame = model.fluid_frame;
  if (frame.isIdentity() && !water) return wetVolumeInF(model, plane_B);
  const SurfacePlane plane_F = seenFrom(plane_B, frame);
  const WetVolume wet = wetVolumeInF(model, plane_F);
  return (water ? waterInside(*model.holds, water, plane_F, frame, model.excess_density).with(wet)
                : wet)
      .inB(frame);
}

Matrix6 inertiaAt(const SurfaceModel& model, const Immersion& immersion) noexcept {
  const Matrix6 in_F = model.wetted->inertia(immersion);
  AMBIENT_ASSERT(isSymmetric(in_F, 1e-9));
  if (model.fluid_frame.isIdentity()) return model.above.inertia + model.added_density * in_F;
  const FrameOffset& frame = model.fluid_frame;
  const Matrix6 in_B =
      frame.rotation.isIdentity(0) ? shiftOrigin(in_F, -frame.translation) : frame.inertiaToB(in_F);
  return model.above.inertia + model.added_density * 0.5 * (in_B + in_B.transpose());
}

Matrix6 positiveInertia(const SurfaceModel& model, const Matrix6& inertia) noexcept {
  constexpr double kLeast = kLeastShare;
  const Cholesky<6> own(model.above.inertia);
  const Matrix6 inverse_root = own.inverseTransposed();
  const Matrix6 relative = inverse_root.transpose() * inertia * inverse_root;
  auto eigen = symmetricEigen<6>(relative);
  for (double& share : eigen.values)
    if (share < kLeast) share = kLeast / 2 + kLeast * kLeast / (4 * (1.5 * kLeast - share));
  const Matrix6 axes = own.lower() * eigen.vectors;
  return axes * eigen.values.asDiagonal() * axes.transpose();
}

}  // namespace ambient
