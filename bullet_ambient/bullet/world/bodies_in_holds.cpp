#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/world/fluid_action.h"

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

MotionView nowOf(const MovingBody& moving) {
  return moving.link ? moving.link->now : motionOf(*moving.body->body);
}
bool isAwake(const MovingBody& moving) {
  return moving.link ? !isAsleep(*moving.body->multi_body) : moving.body->body->isActive();
}

bool isVesselAtSurface(const AmbientBody& body) { return body.vessel && body.surface(); }

/// Puts all bodies out of holds. Returns the volume of the largest hold at a surface [m^3]; 0: no
/// body fits in one, and none was there before.
double leaveHolds(AmbientBodies& bodies) {
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  std::size_t count = 0;
  bodies.forEach([&](AmbientBody& body) {
    body.in_hold = -1;
    ++count;
    smallest = std::min(smallest, body.def->fluid_body->volume);
    if (!isVesselAtSurface(body)) return;
    for (const HoldShape& hold : body.surface()->holds->shapes)
      largest = std::max(largest, hold.capacity());
  });
  bodies.west_to_east.clear();
  bodies.west_to_east.reserve(count);
  const bool were_any = !bodies.regions.in_holds.empty();
  bodies.regions.in_holds.clear();
  bodies.regions.in_holds.reserve(count);
  return were_any || smallest < largest ? largest : 0;
}

/// Gathers the vessels of this world and what may be in one of their holds, and places links.
/// Returns whether there is any such body; then, and only then, they are from west to east.
bool gatherMovingBodies(const btCollisionWorld& world, AmbientBodies& bodies) {
  const double largest = leaveHolds(bodies);
  if (!(largest > 0)) return false;
  std::vector<MovingBody>& west_to_east = bodies.west_to_east;
  bool may_be_inside = false;
  const auto place = [&](AmbientBody& body, const AmbientLink* link, const Vector3& centre) {
    const bool is_small = body.def->fluid_body->volume < largest;
    if (!(is_small || isVesselAtSurface(body)) || !centre.allFinite()) return;
    west_to_east.push_back({centre, west_to_east.size(), &body, link});
    may_be_inside = may_be_inside || is_small;
  };
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    AmbientBody* const ambient = bodies.find(objects[i]);
    if (ambient && !objects[i]->isStaticOrKinematicObject())
      place(*ambient, nullptr, toVector3(objects[i]->getWorldTransform().getOrigin()));
  }
  forEachTreeIn(world, bodies.trees, [&](AmbientTree& tree) {
    computeLinkPosesNow(tree);
    for (const auto& link : tree.links)
      if (link->mass.mass > 0) place(link->ambient, link.get(), link->now.centre());
  });
  if (!may_be_inside) return false;
  std::sort(west_to_east.begin(), west_to_east.end(), [](const MovingBody& a, const MovingBody& b) {
    return a.centre.x() < b.centre.x() || (a.centre.x() == b.centre.x() && a.number < b.number);
  });
  return true;
}

/// Calls visit(const MovingBody&) for the others whose centre is no farther from that of a vessel
/// than the vessel reaches, from west to east. `vessel`: one of `west_to_east`.
template <class Visit>
void forEachNear(const std::vector<MovingBody>& west_to_east, const MovingBody& vessel,
                 const Visit& visit) {
  const double reach = vessel.body->surface()->radius;
  const double west = vessel.centre.x() - reach, east = vessel.centre.x() + reach;
  const MovingBody *moving = &vessel, *const end = west_to_east.data() + west_to_east.size();
  while (moving != west_to_east.data() && !(moving[-1].centre.x() < west)) --moving;
  for (; moving != end && moving->centre.x() <= east; ++moving)
    if (moving->body != vessel.body &&
        (moving->centre - vessel.centre).squaredNorm() < reach * reach)
      visit(*moving);
}

/// A vessel at its present pose.
struct Vessel {
  Vessel(const MovingBody& of, AmbientBodies& among)
      : place(of),
        bodies(among),
        ambient(*of.body),
        now(nowOf(of)),
        is_awake(isAwake(of)),
        R_WF(now.rotation() * ambient.surface()->fluid_frame.rotation),
        origin_W(now.centre() + now.rotation() * ambient.surface()->fluid_frame.translation),
        sea_F(seenFrom(ambient.floating->plane_W, R_WF, origin_W)),
        normal_W(-(now.gravity - ambient.medium.acceleration).normalized()),
        normal_F(R_WF.transpose() * normal_W) {}

  const MovingBody& place;
  AmbientBodies& bodies;
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

/// Puts a body near a vessel into the hold that has its centre, unless it is in a smaller vessel.
void enterHold(const Vessel& vessel, const MovingBody& moving) {
  AmbientBody& body = *moving.body;
  FluidRegions& regions = vessel.bodies.regions;
  const double size = vessel.ambient.metric().reference_length;
  const HoldAround* const known = aroundOf(body, regions);
  if (known && !(size < known->size)) return;
  const Vector3 place_F = vessel.R_WF.transpose() * (moving.centre - vessel.origin_W);
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
    around.region = vessel.ambient.location.region;
    around.size = size;
    around.is_awake = vessel.is_awake;
    around.normal_W = vessel.normal_W;
    around.vessel_W = vessel.now.twist_W;
    around.centre_W = vessel.now.centre();
    return;
  }
}

/// Calls visit(const MovingBody&, HoldAround&) for what is in a vessel, from west to east: the
/// same bits of sums in each order of the bodies.
template <class Visit>
void forEachInside(const MovingBody& vessel, AmbientBodies& bodies, const Visit& visit) {
  forEachNear(bodies.west_to_east, vessel, [&](const MovingBody& moving) {
    HoldAround* const around = aroundOf(*moving.body, bodies.regions);
    if (around && around->vessel == vessel.body) visit(moving, *around);
  });
}
template <class Visit>
void forEachInHold(const Vessel& vessel, std::size_t hold, const Visit& visit) {
  forEachInside(vessel.place, vessel.bodies, [&](const MovingBody& moving, HoldAround& around) {
    if (around.hold == hold) visit(moving, around);
  });
}

/// Whether the level of a hold hangs on other bodies, or did so a step before.
bool isShared(const MovingBody& vessel, AmbientBodies& bodies) {
  const std::vector<HoldState>& holds = vessel.body->vessel->holds;
  bool is_any = std::any_of(holds.begin(), holds.end(),
                            [](const HoldState& hold) { return hold.displaced != 0; });
  if (bodies.regions.in_holds.empty()) return is_any;
  forEachInside(vessel, bodies, [&](const MovingBody&, HoldAround&) { is_any = true; });
  return is_any;
}

/// Volume and area of a body below a level of the vessel's hold, a height in F.
Waterplane displacedBy(const MovingBody& moving, const Vessel& vessel, double height,
                       double& volume) {
  const FluidModels& models = *moving.body->models;
  if (models.surfaces.empty()) return {};
  const MotionView now = nowOf(moving);
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
void findLevel(const Vessel& vessel, std::size_t hold) {
  constexpr double kEmpty = 1e-12, kAccuracy = 1e-12;  // of the hold
  constexpr int kMostSteps = 60;
  HoldState& state = vessel.ambient.vessel->holds[hold];
  const HoldShape& shape = vessel.ambient.surface()->holds->shapes[hold];
  const Vector3& normal_F = vessel.normal_F;
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
      forEachInHold(vessel, hold, [&](const MovingBody& moving, HoldAround&) {
        area -= displacedBy(moving, vessel, height, displaced).area;
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
  forEachInHold(vessel, hold, [&](const MovingBody& moving, HoldAround& around) {
    around.is_dry = is_dry;
    around.height = height_W;
    if (!is_dry && around.is_awake && !isAwake(moving)) wake(*moving.body);
  });
}

/// Gathers what the bodies in the holds have of drag on the water there, which the vessel takes in
/// the next step. Bodies that rows have moved have none.
void gatherReactions(const Vessel& vessel) {
  VesselState& state = *vessel.ambient.vessel;
  const Vector3 centre = vessel.now.centre();
  forEachInside(vessel.place, vessel.bodies, [&](const MovingBody& moving, HoldAround& around) {
    const auto* const last = std::get_if<LastFlight>(&moving.body->outcome.motion);
    if (around.is_dry || moving.link || !isAwake(moving) || !last || !last->memory.has_load) return;
    const Wrench& drag = last->memory.load_W;
    const Vector3 arm = moving.centre - centre;
    state.reaction_W -= drag.aboutOrigin(arm);
    const Twist& of_vessel = vessel.now.twist_W;
    const Vector3 past =
        nowOf(moving).twist_W.linear - of_vessel.linear - of_vessel.angular.cross(arm);
    state.reaction_speed = std::max(state.reaction_speed, past.norm());
  });
}

/// Puts the bodies into the holds that they are in.
void enterHolds(AmbientBodies& bodies) {
  for (const MovingBody& moving : bodies.west_to_east) {
    if (!isVesselAtSurface(*moving.body)) continue;
    std::optional<Vessel> vessel;
    forEachNear(bodies.west_to_east, moving, [&](const MovingBody& other) {
      if (!vessel) vessel.emplace(moving, bodies);
      enterHold(*vessel, other);
    });
  }
}

}  // namespace

void findBodiesInHolds(btCollisionWorld& world, AmbientBodies& bodies) noexcept {
  if (gatherMovingBodies(world, bodies)) enterHolds(bodies);
  for (const MovingBody& moving : bodies.west_to_east) {
    if (!isVesselAtSurface(*moving.body)) continue;
    moving.body->vessel->reaction_W = {};
    moving.body->vessel->reaction_speed = 0;
    if (!isShared(moving, bodies)) continue;
    const Vessel vessel(moving, bodies);
    for (std::size_t i = 0; i < moving.body->vessel->holds.size(); ++i) findLevel(vessel, i);
    gatherReactions(vessel);
  }
}

AMBIENT_END
