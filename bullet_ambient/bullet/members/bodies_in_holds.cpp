#include "bullet_ambient/bullet/members/bodies_in_holds.h"

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/core/body_motion.h"

AMBIENT_BEGIN
namespace {

/// Whether a point is in a closed surface, by the solid angle under which it is seen [Van Oosterom,
/// Strackee].
bool isInside(const Surface& surface, const Vector3& point) {
  const auto corner = [&](std::int32_t vertex) -> Vector3 {
    return vertexOf(surface, vertex) - point;
  };
  double angle = 0;
  for (std::size_t i = 0; i < surface.triangles.size(); i += 3) {
    const Vector3 a = corner(surface.triangles[i]), b = corner(surface.triangles[i + 1]),
                  c = corner(surface.triangles[i + 2]);
    const double p = a.norm(), q = b.norm(), r = c.norm();
    angle += 2 * portable::atan2(a.dot(b.cross(c)),
                                 p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q);
  }
  return std::abs(angle) > 2 * kPi;
}

/// Calls visit(AmbientBody&) for the members among the bodies of a world that move.
template <class Visit>
void forEachBody(const btCollisionWorld& world, const AmbientBodies& bodies, const Visit& visit) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    AmbientBody* const ambient = bodies.find(objects[i]);
    if (ambient && !objects[i]->isStaticOrKinematicObject()) visit(*ambient);
  }
}

Vector3 centreOf(const AmbientBody& ambient) {
  return toVector3(ambient.body->getWorldTransform().getOrigin());
}

/// A vessel at its present pose.
struct Vessel {
  explicit Vessel(AmbientBody& of)
      : ambient(of),
        now(motionOf(*of.body)),
        R_WF(now.rotation() * of.surface()->fluid_frame.rotation),
        origin_W(now.centre() + now.rotation() * of.surface()->fluid_frame.translation),
        sea_F(seenFrom(of.floating->plane_W, R_WF, origin_W)),
        normal_W(-(now.gravity - of.medium.acceleration).normalized()),
        normal_F(R_WF.transpose() * normal_W) {}

  AmbientBody& ambient;
  MotionView now;
  Matrix3 R_WF;
  Vector3 origin_W;
  SurfacePlane sea_F;          ///< surface of the water outside
  Vector3 normal_W, normal_F;  ///< of levels, from what a saved state has
};

/// Whether a hold is full, and the water outside covers it: they are one.
bool isOfTheSea(const Vessel& vessel, std::size_t hold) {
  constexpr double kFull = 1 - 1e-9;  // of a hold
  const HoldShape& shape = vessel.ambient.surface()->holds->shapes[hold];
  return vessel.ambient.vessel->holds[hold].filled() >= kFull * shape.capacity() &&
         computeExtent(shape.hull(), vessel.sea_F.normal).second < vessel.sea_F.height;
}

/// Returns the hold around a body; null: none.
HoldAround* aroundOf(const AmbientBody& body, FluidRegions& regions) {
  if (body.in_hold < 0) return nullptr;
  return &regions.in_holds[static_cast<std::size_t>(body.in_hold)];
}

/// Puts a body into the hold of a vessel that has its centre, unless it is in a smaller one.
void enterHold(const Vessel& vessel, AmbientBody& body, FluidRegions& regions) {
  const SurfaceModel& model = *vessel.ambient.surface();
  const Vector3 way = centreOf(body) - vessel.now.centre();
  const double size = vessel.ambient.metric().reference_length;
  if (!(way.squaredNorm() < model.radius * model.radius)) return;
  const HoldAround* const known = aroundOf(body, regions);
  if (known && !(size < known->size)) return;
  const Vector3 place_F = vessel.R_WF.transpose() * (centreOf(body) - vessel.origin_W);
  const std::vector<Hold>& holds = vessel.ambient.vessel->shape->holds;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (isOfTheSea(vessel, i) || !isInside(holds[i].surface, place_F)) continue;
    if (!known) {
      body.in_hold = static_cast<int>(regions.in_holds.size());
      regions.in_holds.emplace_back();
    }
    HoldAround& around = *aroundOf(body, regions);
    around.vessel = &vessel.ambient;
    around.hold = i;
    around.region = vessel.ambient.place.region;
    around.size = size;
    around.is_awake = vessel.ambient.body->isActive();
    around.normal_W = vessel.normal_W;
    around.vessel_W = vessel.now.twist_W;
    around.centre_W = vessel.now.centre();
    return;
  }
}

/// Calls visit(AmbientBody&, HoldAround&) for the bodies in a hold.
template <class Visit>
void forEachInHold(const btCollisionWorld& world, AmbientBodies& bodies, const Vessel& vessel,
                   std::size_t hold, const Visit& visit) {
  forEachBody(world, bodies, [&](AmbientBody& body) {
    HoldAround* const around = aroundOf(body, bodies.regions);
    if (around && around->vessel == &vessel.ambient && around->hold == hold) visit(body, *around);
  });
}

/// Volume and area of a body below a level of the vessel's hold, a height in F.
Waterplane displacedBy(const AmbientBody& body, const Vessel& vessel, double height,
                       double& volume) {
  if (body.models->surfaces.empty()) return {};
  const MotionView now = motionOf(*body.body);
  const Vector3& normal = vessel.normal_W;
  const SurfacePlane plane_W{normal, height + normal.dot(vessel.origin_W), 0, 0};
  const WetVolume wet = immersionOf(body.models->surfaces.front().model,
                                    seenFrom(plane_W, now.rotation(), now.centre()))
                            .wet;
  volume += wet.volume;
  return wet.waterplane;
}

/// Finds the level in a hold with what floats there: V_hold(h) - sum of V_body(h) is the volume of
/// its water, docs/theory.md eq. (155). Newton's method between brackets.
void findLevel(const btCollisionWorld& world, AmbientBodies& bodies, const Vessel& vessel,
               std::size_t hold) {
  constexpr double kEmpty = 1e-12, kAccuracy = 1e-12;  // of the hold
  constexpr int kMostSteps = 60;
  HoldState& state = vessel.ambient.vessel->holds[hold];
  const HoldShape& shape = vessel.ambient.surface()->holds->shapes[hold];
  const Vector3& normal_F = vessel.normal_F;
  bool is_any = false;
  forEachInHold(world, bodies, vessel, hold, [&](AmbientBody&, HoldAround&) { is_any = true; });
  if (!is_any && state.displaced == 0) return;
  double displaced = 0, height = 0;
  const bool is_dry = !(state.volume > kEmpty * shape.capacity());
  if (!is_dry) {
    auto [low, high] = computeExtent(shape.hull(), normal_F);
    // Not from the last level: a restored state begins with the same bits.
    height =
        fillHold(shape, normal_F, state.volume, std::numeric_limits<double>::quiet_NaN()).height;
    for (int i = 0; i < kMostSteps; ++i) {
      const WetVolume full = computeWetVolume(shape.hull(), {normal_F, height, 0, 0});
      double area = full.waterplane.area;
      displaced = 0;
      forEachInHold(world, bodies, vessel, hold, [&](AmbientBody& body, HoldAround&) {
        area -= displacedBy(body, vessel, height, displaced).area;
      });
      const double error = full.volume - displaced - state.volume;
      if (std::abs(error) <= kAccuracy * shape.capacity()) break;
      (error > 0 ? high : low) = height;
      height = area > 0 ? height - error / area : low;
      if (!(low < height && height < high)) height = (low + high) / 2;
    }
    displaced = std::min(displaced, shape.capacity() - state.volume);
  }
  if (displaced != state.displaced) vessel.ambient.floating->is_valid = false;
  state.displaced = displaced;
  const double height_W = height + vessel.normal_W.dot(vessel.origin_W);
  forEachInHold(world, bodies, vessel, hold, [&](AmbientBody& body, HoldAround& around) {
    around.is_dry = is_dry;
    around.height = height_W;
    if (!is_dry && around.is_awake && !body.body->isActive()) body.body->activate();
  });
}

}  // namespace

void findBodiesInHolds(btCollisionWorld& world, AmbientBodies& bodies) noexcept {
  std::size_t count = 0;
  bodies.forEach([&](AmbientBody& body) {
    body.in_hold = -1;
    ++count;
  });
  bodies.regions.in_holds.clear();
  bodies.regions.in_holds.reserve(count);
  const auto forEachVessel = [&](const auto& visit) {
    forEachBody(world, bodies, [&](AmbientBody& body) {
      if (body.vessel && body.surface()) visit(Vessel(body));
    });
  };
  forEachVessel([&](const Vessel& vessel) {
    forEachBody(world, bodies, [&](AmbientBody& body) {
      if (&body != &vessel.ambient) enterHold(vessel, body, bodies.regions);
    });
  });
  forEachVessel([&](const Vessel& vessel) {
    for (std::size_t i = 0; i < vessel.ambient.vessel->holds.size(); ++i)
      findLevel(world, bodies, vessel, i);
  });
}

AMBIENT_END
