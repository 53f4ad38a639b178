#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/force/medium/fluid_region.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {

inline constexpr double kFar = std::numeric_limits<double>::infinity();
inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

inline BodyDef tumblingBody(const Vector3& position) {
  return {2, ellipsoidMoments(kUnequalAxes, 2),
          startAt(position, {Vector3(1, 2, 3), Vector3(2, 0, 1)})};
}

inline FluidRegion filledWith(const Medium& medium) {
  FluidRegion region;
  region.below = medium;
  return region;
}

inline FluidRegion halfSpace(int axis, double from, const Medium& medium) {
  FluidRegion region = filledWith(medium);
  region.bounds = RegionBounds{Vector3::Constant(-kFar), Vector3::Constant(kFar)};
  region.bounds->lowest[axis] = from;
  return region;
}

/// Kinds of a body: a btRigidBody, or the base of a btMultiBody that carries a pendulum.
enum class Mover { kRigid, kLink };
inline constexpr Mover kMovers[] = {Mover::kRigid, Mover::kLink};
inline constexpr double kRates[] = {60, 240};  // [1/s]

struct LongCase {
  Mover mover;
  double rate;  // steps per second

  std::string text() const {
    return (mover == Mover::kRigid ? "rigid body, " : "link, ") + std::to_string(rate) + " Hz";
  }
};

inline std::vector<LongCase> longCases() {
  std::vector<LongCase> cases;
  for (const Mover mover : kMovers)
    for (const double rate : kRates) cases.push_back({mover, rate});
  return cases;
}

/// A box at the origin in a world without gravity, with one degree of freedom. As a link it hangs
/// by a joint on a base that is fixed.
struct LongScene : RobotWorld {
  enum class Freedom { kTurnsAboutZ, kMovesAlongY };

  void add(const Vector3& size, double density, Mover mover, Freedom freedom) {
    const double mass = density * size.prod();
    const btVector3 moments = toBullet(boxMoments(size, mass));
    const bool turns = freedom == Freedom::kTurnsAboutZ;
    AttachDef def{longBox(size, 8)};
    def.flow.law = PressureLaw::kForm;
    if (mover == Mover::kRigid) {
      body = &contents.add(mass, moments, no_shape_, btTransform::getIdentity());
      body->setActivationState(DISABLE_DEACTIVATION);
      body->setAngularFactor({0, 0, bt(turns ? 1 : 0)});
      fluid.add(*body, def);
      return;
    }
    auto robot = std::make_unique<btMultiBody>(1, 0, btVector3(0, 0, 0), true, false);
    const btQuaternion straight = btQuaternion::getIdentity();
    const btVector3 none(0, 0, 0);
    if (turns) {
      robot->setupRevolute(0, bt(mass), moments, -1, straight, {0, 0, 1}, none, none, true);
    } else {
      robot->setupPrismatic(0, bt(mass), moments, -1, straight, {0, 1, 0}, none, none, true);
    }
    robot->finalizeMultiDof();
    tree = &takeUndamped(std::move(robot));
    fluid.add(*tree, 0, def);
  }
  /// About z [rad/s], or along y [m/s].
  double speed(Freedom freedom) const {
    if (tree) return static_cast<double>(tree->getJointVel(0));
    return static_cast<double>(freedom == Freedom::kTurnsAboutZ ? body->getAngularVelocity().z()
                                                                : body->getLinearVelocity().y());
  }
  void setSpin(double spin) {
    if (body) body->setAngularVelocity({0, 0, bt(spin)});
    if (tree) tree->setJointVel(0, bt(spin));
  }

  btRigidBody* body = nullptr;
  btMultiBody* tree = nullptr;

 private:
  btEmptyShape no_shape_;
};

inline Medium longWater(const Vector3& velocity = Vector3::Zero()) {
  return {1000, 0, velocity, Vector3::Zero()};
}

inline constexpr double kTurning = 0.5;  // [rad/s]

inline FluidRegion turningWater(double rate) {
  FluidRegion region = filledWith(longWater());
  region.flow = [rate](const Vector3& p, double) {
    return FlowSample{{-rate * p.y(), rate * p.x(), 0}, {0, 0, 0}};
  };
  return region;
}

}  // namespace ambient::test
