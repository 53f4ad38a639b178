#include "bullet_ambient/immersed/floating_state.h"

#include <cmath>
#include <cstddef>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/surface/flotation.h"

namespace ambient {
namespace {

// Whether two planes are one but for a rounding of poses, relative to their place in W.
bool isSameButRounding(const SurfacePlane& a, const SurfacePlane& b, double size, double rounding) {
  return a.density == b.density && a.gravity == b.gravity && a.sides_F == b.sides_F &&
         (a.normal - b.normal).cwiseAbs().maxCoeff() <= rounding &&
         std::abs(a.height - b.height) <= rounding * size;
}

bool isSame(const SurfacePlane& a, const SurfacePlane& b) {
  return a.normal == b.normal && a.height == b.height && a.density == b.density &&
         a.gravity == b.gravity && a.sides_F == b.sides_F;
}

}  // namespace

void moveFlotationTo(const SurfacePlane& plane_B, FloatingState& floating) noexcept {
  if (floating.is_valid && isSame(floating.flotation.plane, plane_B)) {
    floating.has_plane = true;
  } else {
    floating.setPlane(plane_B);
  }
}

void completeFlotationsOf(AmbientBody* const* bodies, int count) noexcept {
  const SurfaceModel* models[kFlightsTogether] = {};
  Flotation* flotations[kFlightsTogether] = {};
  int made = 0;
  for (int i = 0; i < count; ++i) {
    FloatingState& floating = *bodies[i]->floating;
    if (floating.is_valid) continue;
    const SurfaceModel& model = *bodies[i]->surface();
    static_cast<SurfacePlace&>(floating.flotation) =
        placeAt(model, floating.flotation.plane, waterAtFlotation(*bodies[i]));
    floating.is_valid = true;
    models[made] = &model;
    flotations[made++] = &floating.flotation;
  }
  if (made > 0) completeFlotations(models, flotations, made);
}

BodyModel modelAtFlotation(const SurfaceModel& at, const Flotation& flotation) {
  BodyModel model = frozenAt(at, flotation);
  const PartLoads& below = at.loads_below;
  if (!below.loads) return model;
  model.loads = below.loads;
  model.load_frame = below.frame;
  model.wet = WetPart{seenFrom(flotation.plane, below.frame),
                      wetShare(flotation.immersion_F, at.shape->volume)};
  giveResistance(model, below.resistance);
  return model;
}

namespace {

// Sets the plane of the flotation to that at a pose, unless they differ by the rounding of the pose
// only.
void updatePlane(AmbientBody& ambient, const RigidState& state, double rounding) {
  constexpr double kRoundings = 64;
  FloatingState& floating = *ambient.floating;
  const SurfacePlane plane_B = planeAt(ambient, state);
  const double size = ambient.surface()->radius + state.position.norm();
  if (floating.has_plane &&
      isSameButRounding(floating.flotation.plane, plane_B, size, kRoundings * rounding))
    return;
  moveFlotationTo(plane_B, floating);
}

}  // namespace

SurfacePlane planeAt(const AmbientBody& ambient, const RigidState& state) noexcept {
  return seenFrom(ambient.floating->plane_W, state.orientation.toRotationMatrix(), state.position);
}

Vector6 twistInWater(const AmbientBody& ambient, const RigidState& state) noexcept {
  Twist relative = state.twist;
  relative.linear -= state.orientation.toRotationMatrix().transpose() * ambient.medium.velocity;
  return relative.vector();
}

bool hasSurface(const RegionSample& sample, const Vector3& gravity) noexcept {
  return gravity.norm() > 0 && (gravity - sample.below.acceleration).norm() > 0;
}

Vector3 leanOf(const RegionSample& sample, const Vector3& gravity) noexcept {
  return (gravity - sample.below.acceleration).dot(gravity.normalized()) * sample.tilt;
}

namespace {

// Returns the surface near a position as a plane in W: normal against gravity as the water feels
// it, g - a, and as it is inclined, leanOf(); through the surface point straight above or below
// the position. @pre hasSurface()
SurfacePlane planeNear(const Vector3& position, const RegionSample& sample,
                       const Vector3& gravity) {
  Vector3 felt = gravity - sample.below.acceleration;
  if (!sample.tilt.isZero(0)) felt += leanOf(sample, gravity);
  const Vector3 normal = -felt.normalized();
  const Vector3 above = position - sample.height * gravity.normalized();
  return {normal, normal.dot(above), sample.below.density - sample.above.density, felt.norm()};
}

// Returns where a body is as it is filled: above and below a surface, holds are full of the fluid
// there, else the body is at it.
SurfaceSide withWater(const AmbientBody& ambient, const SurfaceModel& model, SurfaceSide side) {
  const HoldState* const water = waterOf(ambient);
  if (!water || side == SurfaceSide::kAt) return side;
  const bool is_as_around =
      side == SurfaceSide::kAbove ? areEmpty(*model.holds, water) : areFull(*model.holds, water);
  return is_as_around ? side : SurfaceSide::kAt;
}

}  // namespace

NearSurface nearSurface(const AmbientBody& ambient, const MotionView& now, const SurfaceKind& kind,
                        const RegionSample& sample, const Vector3& point_W,
                        double duration) noexcept {
  const Vector3& gravity = now.gravity;
  const int media = ambient.models->findSurface(kind);
  if (media < 0 || !hasSurface(sample, gravity))
    return {sample.isAbove() ? SurfaceSide::kAbove : SurfaceSide::kBelow};
  const SurfaceModel& model = ambient.models->surfaces[static_cast<std::size_t>(media)].model;
  const RigidState& state = now.state;
  const SurfacePlane plane_W = planeNear(point_W, sample, gravity);
  const double speed = (now.twist_W.linear - sample.below.velocity).norm();
  const double travel =
      duration * (speed + model.radius * state.twist.angular.norm() + duration * gravity.norm());
  const SurfacePlane plane_B =
      seenFrom(plane_W, state.orientation.toRotationMatrix(), state.position);
  return {withWater(ambient, model, sideOf(model, plane_B, travel)), media, plane_W, plane_B};
}

SurfaceSide enterSurface(AmbientBody& ambient, const NearSurface& near, const RegionSample& sample,
                         const PoolSides& sides_F) noexcept {
  const bool is_cut = sides_F.count > 0 && near.side != SurfaceSide::kAbove;
  if (near.media < 0 || (near.side != SurfaceSide::kAt && !is_cut)) return near.side;
  if (ambient.surface_media != near.media) ambient.floating->is_valid = false;
  ambient.surface_media = near.media;
  FloatingState& floating = *ambient.floating;
  floating.plane_W = near.plane_W;
  floating.velocity_above = sample.above.velocity;
  if (!is_cut) return SurfaceSide::kAt;
  ambient.flow_along->sides_F = sides_F;
  floating.plane_W.sides_F = &ambient.flow_along->sides_F;
  ambient.floating->has_plane = ambient.floating->is_valid =
      false;  // its flotation had other sides
  return SurfaceSide::kAt;
}

void updateFlotations(AmbientBody* const* bodies, const RigidState* states, int count,
                      double rounding) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  for (int i = 0; i < count; ++i) updatePlane(*bodies[i], states[i], rounding);
  completeFlotationsOf(bodies, count);
}

BodyModel modelNow(const AmbientBody& ambient, const MotionView& now) {
  const SurfaceModel* surface = ambient.surface();
  if (!surface) return ambient.model();
  WaterInside inside;
  return modelAtFlotation(
      *surface, flotationAt(*surface, planeAt(ambient, now.state), {waterOf(ambient), &inside}));
}

const Flotation& flotationNow(AmbientBody& ambient, const MotionView& now) noexcept {
  AmbientBody* const body = &ambient;
  updateFlotations(&body, &now.state, 1, now.rounding);
  return ambient.flotation();
}

std::optional<SurfacePlane> lastPlane(const AmbientBody& ambient) noexcept {
  if (!ambient.floating || !ambient.floating->has_plane) return std::nullopt;
  return ambient.flotation().plane;
}

void restoreFloating(AmbientBody& ambient, const RigidState& now, int media) noexcept {
  FloatingState& floating = *ambient.floating;
  AMBIENT_ASSERT(ambient.floating->has_plane);
  ambient.surface_media = media;
  const SurfacePlane met = ambient.flotation().plane;
  const Vector3 normal_W = now.orientation * met.normal;
  floating.plane_W = {normal_W, met.height + normal_W.dot(now.position), met.density, met.gravity};
  ambient.floating->setPlane(met);
  AmbientBody* const body = &ambient;
  completeFlotationsOf(&body, 1);
}

bool mayRestAtSurface(AmbientBody& ambient, const MotionView& now) noexcept {
  return isStable(*ambient.surface(), flotationNow(ambient, now));
}

}  // namespace ambient
