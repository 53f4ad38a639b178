#include "bullet_ambient/bullet/world/bodies_in_holds.h"

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/attach.h"

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

/// A body or link at its present pose.
struct Member {
  AmbientBody& ambient;
  const AmbientLink* link = nullptr;  ///< null: a rigid body

  Vector3 centre() const {
    return link ? link->now.centre() : toVector3(ambient.body->getWorldTransform().getOrigin());
  }
  MotionView now() const { return link ? link->now : motionOf(*ambient.body); }
  bool isAwake() const { return link ? !isAsleep(*ambient.multi_body) : ambient.body->isActive(); }
};

constexpr int kAway = -2;  // AmbientBody::in_hold of what does not move in this world

/// Sets AmbientBody::in_hold of all members to -1 or kAway, and places links. Returns how many
/// members there are.
std::size_t findMembers(const btCollisionWorld& world, AmbientBodies& bodies) {
  std::size_t count = 0;
  bodies.forEach([&count](AmbientBody& body) {
    body.in_hold = kAway;
    ++count;
  });
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    AmbientBody* const ambient = bodies.find(objects[i]);
    if (ambient && !objects[i]->isStaticOrKinematicObject()) ambient->in_hold = -1;
  }
  if (!isOf(world, bodies.trees)) return count;
  forEachTree(*bodies.trees.world(), bodies.trees, [](AmbientTree& tree) {
    placeLinksNow(tree);
    for (const auto& link : tree.links)
      if (link->mass.mass > 0) link->ambient.in_hold = -1;
  });
  return count;
}

/// Calls visit(const Member&) for the members that move. @pre findMembers()
template <class Visit>
void forEachMember(AmbientBodies& bodies, const Visit& visit) {
  bodies.forEach([&](AmbientBody& ambient) {
    if (ambient.in_hold == kAway) return;
    visit(Member{ambient, ambient.body ? nullptr : &bodies.trees.linkOf(ambient)});
  });
}

/// A vessel at its present pose.
struct Vessel {
  explicit Vessel(const Member& of)
      : ambient(of.ambient),
        now(of.now()),
        is_awake(of.isAwake()),
        R_WF(now.rotation() * ambient.surface()->fluid_frame.rotation),
        origin_W(now.centre() + now.rotation() * ambient.surface()->fluid_frame.translation),
        sea_F(seenFrom(ambient.floating->plane_W, R_WF, origin_W)),
        normal_W(-(now.gravity - ambient.medium.acceleration).normalized()),
        normal_F(R_WF.transpose() * normal_W) {}

  AmbientBody& ambient;
  MotionView now;
  bool is_awake;
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
void enterHold(const Vessel& vessel, const Member& member, FluidRegions& regions) {
  AmbientBody& body = member.ambient;
  const SurfaceModel& model = *vessel.ambient.surface();
  const Vector3 way = member.centre() - vessel.now.centre();
  const double size = vessel.ambient.metric().reference_length;
  if (!(way.squaredNorm() < model.radius * model.radius)) return;
  const HoldAround* const known = aroundOf(body, regions);
  if (known && !(size < known->size)) return;
  const Vector3 place_F = vessel.R_WF.transpose() * (member.centre() - vessel.origin_W);
  const std::vector<Hold>& holds = vessel.ambient.vessel->shape->holds;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (!(body.def->fluid_body->volume < holds[i].volume)) continue;
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
    around.is_awake = vessel.is_awake;
    around.normal_W = vessel.normal_W;
    around.vessel_W = vessel.now.twist_W;
    around.centre_W = vessel.now.centre();
    return;
  }
}

/// Calls visit(const Member&, HoldAround&) for the bodies in a hold, in the order of the world:
/// that of the members is another one after a state was restored, and so would be the bits of sums.
template <class Visit>
void forEachInHold(const btCollisionWorld& world, AmbientBodies& bodies, const Vessel& vessel,
                   std::size_t hold, const Visit& visit) {
  const auto visitIn = [&](const Member& member) {
    HoldAround* const around = aroundOf(member.ambient, bodies.regions);
    if (around && around->vessel == &vessel.ambient && around->hold == hold) visit(member, *around);
  };
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i)
    if (AmbientBody* const ambient = bodies.find(objects[i])) visitIn({*ambient});
  if (!isOf(world, bodies.trees)) return;
  forEachTree(*bodies.trees.world(), bodies.trees, [&](AmbientTree& tree) {
    for (const auto& link : tree.links) visitIn({link->ambient, link.get()});
  });
}

/// Whether any body is in a hold.
bool hasAny(const FluidRegions& regions, const Vessel& vessel, std::size_t hold) {
  const auto& all = regions.in_holds;
  return std::any_of(all.begin(), all.end(), [&](const HoldAround& around) {
    return around.vessel == &vessel.ambient && around.hold == hold;
  });
}

/// Volume and area of a body below a level of the vessel's hold, a height in F.
Waterplane displacedBy(const Member& member, const Vessel& vessel, double height, double& volume) {
  const FluidModels& models = *member.ambient.models;
  if (models.surfaces.empty()) return {};
  const MotionView now = member.now();
  const Vector3& normal = vessel.normal_W;
  const SurfacePlane plane_W{normal, height + normal.dot(vessel.origin_W), 0, 0};
  const WetVolume wet =
      immersionOf(models.surfaces.front().model, seenFrom(plane_W, now.rotation(), now.centre()))
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
  if (!hasAny(bodies.regions, vessel, hold) && state.displaced == 0) return;
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
      forEachInHold(world, bodies, vessel, hold, [&](const Member& member, HoldAround&) {
        area -= displacedBy(member, vessel, height, displaced).area;
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
  forEachInHold(world, bodies, vessel, hold, [&](const Member& member, HoldAround& around) {
    around.is_dry = is_dry;
    around.height = height_W;
    if (!is_dry && around.is_awake && !member.isAwake()) wake(member.ambient);
  });
}

}  // namespace

void findBodiesInHolds(btCollisionWorld& world, AmbientBodies& bodies) noexcept {
  const std::size_t count = findMembers(world, bodies);
  bodies.regions.in_holds.clear();
  bodies.regions.in_holds.reserve(count);
  const auto forEachVessel = [&](const auto& visit) {
    forEachMember(bodies, [&](const Member& member) {
      if (member.ambient.vessel && member.ambient.surface()) visit(Vessel(member));
    });
  };
  forEachVessel([&](const Vessel& vessel) {
    forEachMember(bodies, [&](const Member& member) {
      if (&member.ambient != &vessel.ambient) enterHold(vessel, member, bodies.regions);
    });
  });
  forEachVessel([&](const Vessel& vessel) {
    for (std::size_t i = 0; i < vessel.ambient.vessel->holds.size(); ++i)
      findLevel(world, bodies, vessel, i);
  });
}

AMBIENT_END
