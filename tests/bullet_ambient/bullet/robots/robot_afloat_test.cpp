#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/part_bodies.h"

// A barge that carries a load on a joint is let go aslant in calm water. Whatever holds the joint,
// its roll dies out as that of the same barge with the load welded on, however long the step.
namespace ambient::test {
namespace {

const Vector3 kHull(6, 2.5, 1.2), kLoad(0.4, 0.4, 0.2);  // [m]
constexpr double kHullMass = 6300, kLoadMass = 100;      // [kg]
constexpr double kMass = kHullMass + kLoadMass;
constexpr double kLoadHeight = 0.7;         // above the middle of the hull [m]
constexpr double kRoll = 0.05 * kPi / 180;  // at the start [rad]
constexpr double kStrong = 1e6;             // impulse of a motor [N s]

enum class Load { kWelded, kFixed, kMotor, kPositionMotor, kLimits, kSwings };

btVector3 momentsOf(double mass, const Vector3& size) {
  const Vector3 squares = size.cwiseProduct(size);
  return toBullet(Vector3(mass / 12 * (Vector3::Constant(squares.sum()) - squares)));
}

// Returns the height of the centre of mass of the base above the middle of the hull [m].
double heightOfBase(Load load) {
  return load == Load::kWelded ? kLoadMass * kLoadHeight / kMass : 0;
}

std::unique_ptr<btMultiBody> weldedBarge() {
  const double height = heightOfBase(Load::kWelded), above = kLoadHeight - height;
  const double apart = kHullMass * height * height + kLoadMass * above * above;
  const btVector3 moments = momentsOf(kHullMass, kHull) + momentsOf(kLoadMass, kLoad) +
                            btVector3(bt(apart), bt(apart), 0);
  return std::make_unique<btMultiBody>(0, bt(kMass), moments, false, false);
}

std::unique_ptr<btMultiBody> bargeWith(Load load) {
  if (load == Load::kWelded) return weldedBarge();
  auto body =
      std::make_unique<btMultiBody>(1, bt(kHullMass), momentsOf(kHullMass, kHull), false, false);
  const btVector3 moments = momentsOf(kLoadMass, kLoad), none(0, 0, 0), athwart(0, 1, 0);
  const btVector3 up(0, 0, bt(kLoadHeight)), hook(0, 0, bt(kLoadHeight + 1)), rope(0, 0, -1);
  const btQuaternion straight = btQuaternion::getIdentity();
  if (load == Load::kFixed) {
    body->setupFixed(0, bt(kLoadMass), moments, -1, straight, up, none);
  } else if (load == Load::kSwings) {
    body->setupRevolute(0, bt(kLoadMass), moments, -1, straight, {1, 0, 0}, hook, rope, true);
  } else {
    body->setupPrismatic(0, bt(kLoadMass), moments, -1, straight, athwart, up, none, true);
  }
  return body;
}

std::unique_ptr<btMultiBodyConstraint> rowsOf(Load load, btMultiBody& body) {
  if (load == Load::kLimits)
    return std::make_unique<btMultiBodyJointLimitConstraint>(&body, 0, bt(0), bt(0));
  if (load != Load::kMotor && load != Load::kPositionMotor) return nullptr;
  auto motor = std::make_unique<btMultiBodyJointMotor>(&body, 0, bt(0), bt(kStrong));
  if (load == Load::kPositionMotor) motor->setPositionTarget(0, bt(0.1));
  return motor;
}

class Barge {
 public:
  explicit Barge(Load load) : Barge(load, bargeWith(load)) {}

  /// Returns the largest tilt from `from` to `to` after the start [rad]; in s.
  double largestTilt(double from, double to, double hertz) {
    double largest = 0;
    for (; steps_ < to * hertz; ++steps_) {
      world_.step(1 / hertz);
      const btVector3 mast = quatRotate(body_.getWorldToBaseRot().inverse(), {0, 0, 1});
      if (steps_ >= from * hertz)
        largest = std::max(largest, static_cast<double>(std::hypot(mast.x(), mast.y())));
    }
    return largest;
  }

 private:
  Barge(Load load, std::unique_ptr<btMultiBody> robot) : body_(*robot) {
    world_.world.setGravity({0, 0, bt(-9.81)});
    world_.world.getSolverInfo().m_numIterations = 10;  // Bullet's default
    world_.fluid.addRegion(seaUnderAir());
    body_.setLinearDamping(0);
    body_.setAngularDamping(0);
    body_.setCanSleep(false);
    body_.finalizeMultiDof();
    const double draught = kMass / (water().density * kHull.x() * kHull.y());
    const double height = heightOfBase(load);
    body_.setBasePos({0, 0, bt(kHull.z() / 2 - draught + height)});
    body_.setWorldToBaseRot(btQuaternion(btVector3(1, 0, 0), bt(-kRoll)));
    // Bullet leaves out motors of links without a collider.
    world_.take(std::move(robot), 0.1);
    if (auto rows = rowsOf(load, body_)) world_.take(std::move(rows));
    AttachDef def;
    def.fluid_body = std::make_shared<FluidBody>(floatingBox(kHull));
    def.medium = air();
    def.fluid_frame.translation = {0, 0, -height};
    world_.fluid.add(body_, -1, def);
  }

  RobotWorld world_;
  btMultiBody& body_;
  int steps_ = 0;
};

// Returns how fast the roll dies out in a minute [1/s].
double decayOf(Load load, double hertz) {
  constexpr double kMinute = 60, kWindow = 10;  // [s]
  Barge barge(load);
  const double first = barge.largestTilt(0, kWindow, hertz);
  const double last = barge.largestTilt(kMinute - kWindow, kMinute, hertz);
  return std::log(first / last) / (kMinute - kWindow);
}

TEST(RobotAfloat, RollsAsWithItsLoadWeldedOn) {
  for (const double hertz : {30.0, 60.0, 120.0}) {
    const double welded = decayOf(Load::kWelded, hertz);
    EXPECT_GT(welded, 0.09);
    for (const Load load : {Load::kFixed, Load::kMotor, Load::kPositionMotor, Load::kLimits})
      EXPECT_NEAR(decayOf(load, hertz) / welded, 1, 0.04)
          << hertz << " Hz, load " << static_cast<int>(load);
  }
}

TEST(RobotAfloat, RollsUnderASwingingLoadAsInShortSteps) {
  const double in_short_steps = decayOf(Load::kSwings, 480);
  for (const double hertz : {30.0, 60.0})
    EXPECT_NEAR(decayOf(Load::kSwings, hertz) / in_short_steps, 1, 0.03) << hertz << " Hz";
}

}  // namespace
}  // namespace ambient::test
