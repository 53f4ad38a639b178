#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

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
