#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "tests/bullet_ambient/bullet/worlds/coupled_scene.h"

// Bullet's features of joints with a body of coupled K in an ideal fluid.
namespace ambient::test {
namespace {

struct OnJoint : CoupledScene {
  explicit OnJoint(unsigned seed) : CoupledScene(seed) {
    stop();
    pivot = toBt(arbitrary.vector(0.5 * coupled.size()));
    axis = toBt(arbitrary.vector().normalized());
  }
  ~OnJoint() {
    if (joint) scene.world.removeConstraint(joint.get());
  }
  template <class Joint>
  Joint& add(Joint* made) {
    joint.reset(made);
    scene.world.addConstraint(made);
    return *made;
  }
  btHingeConstraint& addHinge() { return add(new btHingeConstraint(body(), pivot, axis)); }
  btTransform pose() { return body().getWorldTransform(); }
  Vector3r arm() { return exact(pose().getBasis() * pivot); }
  Vector3r axisInWorld() { return exact(pose().getBasis() * axis); }
  /// Returns the twist of the centre of mass per unit spin about the hinge.
  DenseVector6 hingeTwist() {
    DenseVector6 s;
    s << axisInWorld(), arm().cross(axisInWorld());
    return s;
  }
  double hingeInertia() {
    return static_cast<double>(hingeTwist().dot(coupled.inertia() * hingeTwist()));
  }
  double hingeSpin() {
    return static_cast<double>(exact(body().getAngularVelocity()).dot(axisInWorld()));
  }

  btVector3 pivot, axis;
  std::unique_ptr<btTypedConstraint> joint;
};

// On a hinge d/dt(I_eff spin) = torque: I_eff is constant, and gyroscopic forces of the rest of K
// do no work.
TEST(JointFeatures, AMotorTurnsTheInertiaAboutItsHinge) {
  constexpr int kSteps = 48;
  constexpr double kSpin = 2;
  for (unsigned seed = 0; seed < 10; ++seed) {
    OnJoint scene(seed);
    const double impulse = kSpin * scene.hingeInertia() / kSteps;
    scene.addHinge().enableAngularMotor(true, 1000, bt(impulse));
    scene.scene.step(1.0 / 256, kSteps - 1);
    scene.solve(1.0 / 256);
    EXPECT_NEAR(std::abs(scene.hingeSpin()) / kSpin, 1, 1e-3) << seed;
  }
}

TEST(JointFeatures, AHingeStopsAtItsLimit) {
  constexpr double kLimit = 0.4, kSpin = 2, kStep = 1.0 / 1024;
  for (unsigned seed = 0; seed < 10; ++seed) {
    OnJoint scene(seed);
    btHingeConstraint& hinge = scene.addHinge();
    const btScalar start = hinge.getHingeAngle();
    hinge.setLimit(start - bt(kLimit), start + bt(kLimit), 1, bt(0.3), 0);
    const auto turned = [&] {
      return std::abs(std::remainder(static_cast<double>(hinge.getHingeAngle() - start), 2 * kPi));
    };
    const DenseVector6 u = kSpin * scene.hingeTwist();
    scene.body().setAngularVelocity(toBt(u.head<3>().cast<double>()));
    scene.body().setLinearVelocity(toBt(u.tail<3>().cast<double>()));
    scene.scene.step(kStep, 160);
    EXPECT_NEAR(turned(), kSpin * 160 * kStep, 1e-3) << seed;
    scene.scene.step(kStep, 240);
    EXPECT_GT(turned(), kLimit - 1e-6) << seed;
    EXPECT_LT(turned(), kLimit + kSpin * kStep) << seed;
    // The residual is half of the turning part when the hinge meets its limit.
    EXPECT_NEAR(scene.hingeSpin(), 0, kSpin * kSpin * kStep) << seed;
  }
}

TEST(JointFeatures, AJointBreaksAtTheImpulseOfTheFullInertia) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const double strength : {0.99, 1.01}) {
      OnJoint scene(seed);
      scene.body().setAngularVelocity({1, -2, 1});
      scene.body().setLinearVelocity({-1, 1, 2});
      scene.add(new btPoint2PointConstraint(scene.body(), scene.pivot));
      const double dt = scene.coupled.gyroscopicTime(0.05);
      std::vector<reference::DenseRow> rows;
      for (int i = 0; i < 3; ++i)
        rows.push_back(reference::pointRow(Vector3r::Unit(i), scene.arm(), Vector3r::Zero()));
      reference::DenseBody wall;
      wall.fixed = true;
      const auto impulses = reference::solveDense({scene.coupled.dense(dt), wall}, rows).impulses;
      const auto largest = static_cast<double>(impulses.cwiseAbs().maxCoeff());
      scene.joint->setBreakingImpulseThreshold(bt(strength * largest));
      scene.scene.step(dt);
      EXPECT_EQ(scene.joint->isEnabled(), strength > 1) << seed;
    }
  }
}

TEST(JointFeatures, SubstepsOfACallAreStepsOfTheirOwn) {
  for (const bool has_joint : {false, true}) {
    OnJoint in_calls(6), one_by_one(6);
    for (OnJoint* scene : {&in_calls, &one_by_one}) {
      scene->body().setGravity({0, 0, bt(-9.81)});
      scene->body().setAngularVelocity({1, 2, 3});
      if (has_joint) scene->add(new btPoint2PointConstraint(scene->body(), scene->pivot));
    }
    const btScalar h = bt(1.0 / 256);
    for (int i = 0; i < 64; ++i) in_calls.scene.world.stepSimulation(4 * h, 4, h);
    one_by_one.scene.step(1.0 / 256, 256);
    EXPECT_GT(static_cast<double>(one_by_one.body().getAngularVelocity().length()), 0.1);
    EXPECT_TRUE(in_calls.pose() == one_by_one.pose());
    EXPECT_EQ(in_calls.coupled.velocity(), one_by_one.coupled.velocity());
  }
}

}  // namespace
}  // namespace ambient::test
