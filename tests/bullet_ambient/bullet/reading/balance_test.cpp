// The wrenches that are read against the momentum of the body and the impulses that Bullet reports.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/reading.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

constexpr double kBalanceStep = 1.0 / 120;
constexpr double kBalanceRounding = byPrecision(1e-11, 2e-5);  // of the largest term

enum class Place { kSubmerged, kAtSurface };
enum class Held { kFree, kByContacts, kByJoint };

const std::shared_ptr<const FluidBody>& shape() {
  static const auto made = std::make_shared<const FluidBody>(floatingEllipsoid(kUnequalAxes, 2));
  return made;
}

/// A body of arbitrary density and motion in water that flows, and on request held by something.
class RandomScene {
 public:
  RandomScene(Arbitrary& arbitrary, Place place, Held held) {
    scene.world.setGravity({0, 0, bt(-9.81)});
    addWater(arbitrary, place);
    addBody(arbitrary);
    if (held == Held::kByContacts) addGround(arbitrary);
    if (held == Held::kByJoint) addJoint(arbitrary);
    scene.of(*body).readWrench(true);
  }
  ~RandomScene() {
    if (joint) scene.world.removeConstraint(joint.get());
  }

  void step(const Wrench& force) {
    body->applyCentralForce(toBullet(force.force));
    body->applyTorque(toBullet(force.torque));
    clearSecondFrictions();
    before = momentum();
    scene.step(kBalanceStep);
  }
  Wrench momentum() const {
    const Vector3 spin = toVector3(body->getAngularVelocity());
    const Matrix3 R = toQuaternion(body->getWorldTransform().getRotation()).toRotationMatrix();
    const Vector3 moments = toVector3(body->getInvInertiaDiagLocal()).cwiseInverse();
    return {R * moments.cwiseProduct(R.transpose() * spin),
            toVector3(body->getLinearVelocity()) / static_cast<double>(body->getInvMass())};
  }
  /// Wrench of the contacts and the joint, as Bullet reports them.
  Wrench reported(const btVector3& centre) const {
    Wrench sum;
    for (int i = 0; i < scene.dispatcher.getNumManifolds(); ++i) {
      btPersistentManifold& manifold = *manifoldOf(i);
      const bool is_first = manifold.getBody0() == body;
      for (int k = 0; k < manifold.getNumContacts(); ++k)
        sum += reported(manifold.getContactPoint(k), is_first, centre);
    }
    sum = 1 / kBalanceStep * sum;
    if (joint)
      sum += {toVector3(feedback.m_appliedTorqueBodyA), toVector3(feedback.m_appliedForceBodyA)};
    return sum;
  }

  FluidWorld scene;
  btRigidBody* body = nullptr;
  Wrench before;

 private:
  void addWater(Arbitrary& arbitrary, Place place) {
    FluidRegion sea;
    sea.below = water();
    sea.below.velocity = arbitrary.vector(0.5);
    sea.below.velocity.z() = 0;
    sea.above = air();
    sea.above->velocity = arbitrary.vector(5);
    if (place == Place::kAtSurface)
      sea.surface = std::make_shared<StillWater>(arbitrary.between(-0.1, 0.1), Vector3::UnitZ());
    scene.fluid.addRegion(sea);
  }
  void addBody(Arbitrary& arbitrary) {
    BodyDef def;
    def.mass = arbitrary.between(0.2, 3) * 1000 * shape()->volume;
    def.moments = ellipsoidMoments(kUnequalAxes, def.mass);
    def.start.orientation = Quaternion(arbitrary.rotation());
    def.start.twist = arbitrary.twist(2, 1);
    def.shape = &box;
    body = &scene.add(def);
    scene.fluid.add(*body, {shape()});
  }
  void addGround(Arbitrary& arbitrary) {
    btVector3 lowest, highest;
    body->getAabb(lowest, highest);
    const Vector3 below(0, 0, static_cast<double>(lowest.z()) - 9.96);
    scene.add({0, Vector3::Ones(), startAt(below), &ground})
        .setFriction(bt(arbitrary.between(0, 2)));
    body->setFriction(1);
    body->setLinearVelocity(body->getLinearVelocity() - btVector3(0, 0, bt(1.5)));
  }
  void addJoint(Arbitrary& arbitrary) {
    joint = std::make_unique<btPoint2PointConstraint>(*body, toBullet(arbitrary.vector(0.3)));
    joint->setJointFeedback(&feedback);
    scene.world.addConstraint(joint.get());
  }
  btPersistentManifold* manifoldOf(int i) const {
    return const_cast<btCollisionDispatcher&>(scene.dispatcher).getManifoldByIndexInternal(i);
  }
  // Bullet leaves the impulse of a second friction row that is no more.
  void clearSecondFrictions() {
    for (int i = 0; i < scene.dispatcher.getNumManifolds(); ++i)
      for (int k = 0; k < manifoldOf(i)->getNumContacts(); ++k)
        manifoldOf(i)->getContactPoint(k).m_appliedImpulseLateral2 = 0;
  }
  static Wrench reported(const btManifoldPoint& point, bool is_first, const btVector3& centre) {
    const btVector3 impulse = point.m_appliedImpulse * point.m_normalWorldOnB +
                              point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                              point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
    const btVector3 at = is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
    const Vector3 on_body = (is_first ? 1 : -1) * toVector3(impulse);
    return Wrench::ofForceAt(on_body, toVector3(at - centre));
  }

  btBoxShape box{btVector3(bt(0.2), bt(0.2), bt(0.1))};
  btBoxShape ground{btVector3(10, 10, 10)};
  std::unique_ptr<btPoint2PointConstraint> joint;
  btJointFeedback feedback;
};

double sizeOf(const Wrench& f) { return f.vector().norm(); }

double sizeOf(const FluidWrench& f) {
  double size = 0;
  for (const Wrench& part :
       {f.pressure, f.friction, f.buoyancy, f.waves, f.wind, f.added_mass, f.constraints})
    size += sizeOf(part);
  return size;
}

struct Case {
  Place place;
  Held held;
  const char* name;
};

class Balance : public testing::TestWithParam<Case> {};

// The change of the momentum is that of all parts, and the constraints are those that Bullet
// reports: 200 cases of each kind.
TEST_P(Balance, OfMomentumHoldsToRounding) {
  Arbitrary arbitrary(7);
  double held_most = 0;
  for (int i = 0; i < 200; ++i) {
    RandomScene scene(arbitrary, GetParam().place, GetParam().held);
    Wrench applied{arbitrary.vector(2), arbitrary.vector(20)};
    btVector3 centre(0, 0, 0);
    for (int step = 0; step <= i % 3; ++step) {
      centre = scene.body->getWorldTransform().getOrigin();
      scene.step(applied);
    }
    const double mass = 1 / static_cast<double>(scene.body->getInvMass());
    applied.force.z() += mass * static_cast<double>(scene.scene.world.getGravity().z());
    const FluidWrench read = scene.scene.of(*scene.body).wrench();
    Wrench change = scene.momentum();
    const double size =
        sizeOf(read) + sizeOf(applied) + (sizeOf(change) + sizeOf(scene.before)) / kBalanceStep;
    change -= scene.before;
    Wrench missing = 1 / kBalanceStep * change;
    missing -= applied + read.total() + read.constraints;
    EXPECT_LT(sizeOf(missing), kBalanceRounding * size) << i;
    Wrench unreported = read.constraints;
    unreported -= scene.reported(centre);
    EXPECT_LT(sizeOf(unreported), kBalanceRounding * size) << i;
    held_most = std::max(held_most, sizeOf(read.constraints) / size);
  }
  if (GetParam().held == Held::kFree) {
    EXPECT_EQ(held_most, 0);
  } else {
    EXPECT_GT(held_most, 0.1);  // there was something to tell apart
  }
}

INSTANTIATE_TEST_SUITE_P(
    Reading, Balance,
    testing::Values(Case{Place::kSubmerged, Held::kFree, "Submerged"},
                    Case{Place::kAtSurface, Held::kFree, "AtSurface"},
                    Case{Place::kSubmerged, Held::kByContacts, "SubmergedOnGround"},
                    Case{Place::kAtSurface, Held::kByContacts, "AtSurfaceOnGround"},
                    Case{Place::kAtSurface, Held::kByJoint, "AtSurfaceWithJoint"}),
    [](const auto& info) { return std::string(info.param.name); });

constexpr double kRadius = 5e-3;  // [m]
constexpr double kStokes = 6 * kPi * kRadius;
const Medium kPitch{1400, 100, Vector3::Zero(), Vector3::Zero()};

FluidBody ball() {
  FluidBody shape = facelessEllipsoid(Vector3::Constant(kRadius));
  shape.name = "ball";
  shape.sphere_radius = kRadius;
  return shape;
}

// Balls in a fluid that stops them within a thousandth of the step. Rows meet the resistance, so
// that joints, motors and contacts are as in a steady motion, docs/theory.md eq. (124).
class SettledRows : public ::testing::TestWithParam<double> {
 protected:
  SettledRows() { scene_.world.setGravity({0, 0, bt(-kGravity)}); }

  double volume() const { return 4 * kPi / 3 * kRadius * kRadius * kRadius; }
  double weight(double density) const { return (density - kPitch.density) * volume() * kGravity; }
  btRigidBody& add(double density, const Vector3& position) {
    BodyDef def;
    def.mass = density * volume();
    def.moments = Vector3::Constant(0.4 * def.mass * kRadius * kRadius);
    def.start.position = position;
    def.shape = &round_;
    return scene_.add(def, ball(), kPitch);
  }
  void step(int count) { scene_.step(GetParam(), count); }
  double sinks(const btRigidBody& body) const {
    return -static_cast<double>(body.getLinearVelocity().z());
  }

  FluidWorld scene_;
  btSphereShape round_{bt(kRadius)};
};

TEST_P(SettledRows, TwoBallsOnAJointSinkTogether) {
  btRigidBody& heavy = add(7850, {0, 0, -3 * kRadius});
  btRigidBody& light = add(1500, {0, 0, 0});
  auto owned = std::make_unique<btPoint2PointConstraint>(
      heavy, light, btVector3(0, 0, bt(2 * kRadius)), btVector3(0, 0, bt(-kRadius)));
  btJointFeedback force;
  owned->enableFeedback(true);
  owned->setJointFeedback(&force);
  scene_.contents.join(std::move(owned));
  step(30);
  const double speed = (weight(7850) + weight(1500)) / (2 * kStokes * kPitch.viscosity);
  const double held = weight(7850) - kStokes * kPitch.viscosity * speed;
  EXPECT_NEAR(sinks(heavy) / speed, 1, 2e-3);
  EXPECT_NEAR(sinks(light) / speed, 1, 2e-3);
  EXPECT_NEAR(static_cast<double>(force.m_appliedForceBodyA.z()) / held, 1, 5e-3);
}

TEST_P(SettledRows, AWeakMotorMovesABallAsFarAsItsForceGoes) {
  scene_.world.setGravity({0, 0, 0});
  btRigidBody& body = add(1500, {0, 0, 0});
  auto& slider = static_cast<btGeneric6DofConstraint&>(scene_.contents.join(
      std::make_unique<btGeneric6DofConstraint>(body, btTransform::getIdentity(), true)));
  slider.setLinearLowerLimit({1, 0, 0});  // free along x
  slider.setLinearUpperLimit({-1, 0, 0});
  btTranslationalLimitMotor& motor = *slider.getTranslationalLimitMotor();
  constexpr double kForce = 0.01;  // [N]
  motor.m_enableMotor[0] = true;
  motor.m_targetVelocity[0] = -10;
  motor.m_maxMotorForce[0] = bt(kForce);
  step(30);
  EXPECT_NEAR(std::abs(static_cast<double>(body.getLinearVelocity().x())),
              kForce / (kStokes * kPitch.viscosity), 2e-3 * kForce / kStokes / kPitch.viscosity);
}

TEST_P(SettledRows, TheGroundBearsTheWholeWeight) {
  btStaticPlaneShape plane({0, 0, 1}, 0);
  scene_.contents.add(0, plane);
  btRigidBody& body = add(7850, {0, 0, kRadius});
  step(30);
  EXPECT_LT(std::abs(sinks(body)), 1e-3 * weight(7850) / (kStokes * kPitch.viscosity));
  const btDispatcher& dispatcher = scene_.dispatcher;
  ASSERT_EQ(dispatcher.getNumManifolds(), 1);
  const btPersistentManifold& contact = *scene_.dispatcher.getManifoldByIndexInternal(0);
  double impulse = 0;
  for (int i = 0; i < contact.getNumContacts(); ++i)
    impulse += static_cast<double>(contact.getContactPoint(i).getAppliedImpulse());
  EXPECT_NEAR(impulse / GetParam() / weight(7850), 1, 5e-3);
}

// A body with locked axes has no flight, with or without rows.
TEST_P(SettledRows, ALockedBallMovesAsFarAsItsForceGoes) {
  btRigidBody& body = add(1500, {0, 0, 0});
  body.setLinearFactor({1, 0, 0});
  constexpr double kForce = 0.01;  // [N]
  for (int i = 0; i < 30; ++i) {
    body.applyCentralForce({bt(kForce), 0, 0});
    step(1);
  }
  const double speed = kForce / (kStokes * kPitch.viscosity);
  EXPECT_NEAR(static_cast<double>(body.getLinearVelocity().x()) / speed, 1, 2e-3);
  EXPECT_EQ(sinks(body), 0);
}

INSTANTIATE_TEST_SUITE_P(Steps, SettledRows, ::testing::Values(1.0 / 30, 1.0 / 60, 1.0 / 240));

}  // namespace
}  // namespace ambient::test
