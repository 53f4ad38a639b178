#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/worlds/coupled_scene.h"
#include "tests/bullet_ambient/bullet/worlds/world_setups.h"
#include "tests/support/bodies/free_body.h"

namespace ambient::test {
namespace {

// Bullet's features of joints with a body of coupled K in an ideal fluid.

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

// Soft bodies touch rigid ones after solver and actions, by btRigidBody::applyImpulse(). These
// impulses use the dry mass and inertia, for ambient bodies, too. K acts in the rigid part of the
// next step.

constexpr double kSoftBallRadius = 0.4;

class SoftScene {
 public:
  explicit SoftScene(double gravity) : host_(worldNamed("SoftWithSequentialImpulse").make(true)) {
    soft_world().setGravity({0, 0, bt(-gravity)});
    soft_world().getWorldInfo().m_gravity = soft_world().getGravity();
    soft_world().getWorldInfo().air_density = 0;
  }
  ~SoftScene() {
    if (soft_) soft_world().removeSoftBody(soft_.get());
    if (body_) soft_world().removeRigidBody(body_.get());
  }

  btSoftBody& add(btSoftBody* soft, double mass) {
    soft_.reset(soft);
    soft_->setTotalMass(bt(mass));
    soft_world().addSoftBody(soft);
    return *soft_;
  }
  btSoftBodyWorldInfo& info() { return soft_world().getWorldInfo(); }

  // Adds a sphere of 1 kg.
  btRigidBody& addBall(const Vector3& position, const FluidBody& fluid_body, double density) {
    body_ = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(
        1, nullptr, &ball_, toBullet(Vector3::Constant(0.4 * kSoftBallRadius * kSoftBallRadius))));
    body_->setWorldTransform(btTransform(btQuaternion::getIdentity(), toBullet(position)));
    body_->setActivationState(DISABLE_DEACTIVATION);
    soft_world().addRigidBody(body_.get());
    AttachDef def;
    def.fluid_body = std::make_shared<FluidBody>(fluid_body);
    def.medium.density = density;
    host_->fluid().add(*body_, def);
    return *body_;
  }
  void step(int count) { host_->step(kWorldStep, count); }

 private:
  btSoftRigidDynamicsWorld& soft_world() { return *host_->softWorld(); }

  btSphereShape ball_{bt(kSoftBallRadius)};
  std::unique_ptr<WorldHost> host_;
  std::unique_ptr<btSoftBody> soft_;
  std::unique_ptr<btRigidBody> body_;
};

Vector3 momentumOf(const btSoftBody& soft) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < soft.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = soft.m_nodes[i];
    if (node.m_im > 0) sum += toVector3(node.m_v) / static_cast<double>(node.m_im);
  }
  return sum;
}

TEST(SoftContact, CarriesAnAmbientBodyOnASheet) {
  SoftScene scene(9.81);
  btSoftBody& sheet =
      scene.add(btSoftBodyHelpers::CreatePatch(scene.info(), {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0},
                                               {1, 1, 0}, 17, 17, 1 + 2 + 4 + 8, true),
                2);
  sheet.m_cfg.kDP = bt(0.02);
  // The ball displaces half of its mass.
  const FluidBody shape = meshedEllipsoid(Vector3::Constant(kSoftBallRadius), 1);
  btRigidBody& ball = scene.addBall({0, 0, 0.6}, shape, 0.5 / shape.volume);
  ball.setDamping(bt(0.5), bt(0.5));
  double deepest = 1;
  for (int i = 0; i < 1200; ++i) {
    scene.step(1);
    deepest = std::min(deepest, static_cast<double>(ball.getWorldTransform().getOrigin().z()));
  }
  const Vector3 place = toVector3(ball.getWorldTransform().getOrigin());
  EXPECT_GT(deepest, -0.5);
  EXPECT_LT(place.head<2>().norm(), 0.3);
  EXPECT_LT(static_cast<double>(ball.getLinearVelocity().length()), 0.2);
}

TEST(SoftContact, ExchangesMomentumWithTheDryBody) {
  SoftScene scene(0);
  btSoftBody& soft = scene.add(
      btSoftBodyHelpers::CreateEllipsoid(scene.info(), {0, 0, 0}, {bt(0.5), bt(0.5), bt(0.5)}, 80),
      1);
  soft.m_cfg.kVC = 0;
  // Fluid inertia of twice the body's is the only effect of the fluid.
  btRigidBody& ball = scene.addBall({0, 0, 1.2}, shapeWithoutFaces(2 * Matrix6::Identity(), 0), 1);
  ball.setLinearVelocity({0, 0, -3});
  Vector3 exchanged = Vector3::Zero();
  for (int i = 0; i < 40; ++i) {
    const Vector3 soft_before = momentumOf(soft), ball_before = toVector3(ball.getLinearVelocity());
    scene.step(1);
    const Vector3 gained = momentumOf(soft) - soft_before;
    const Vector3 lost = ball_before - toVector3(ball.getLinearVelocity());
    EXPECT_LT((gained - lost).norm(), byPrecision(1e-13, 1e-5)) << i;
    exchanged += gained;
  }
  EXPECT_LT(exchanged.z(), -1);
  EXPECT_LT(exchanged.head<2>().norm(), 0.3);
}

}  // namespace
}  // namespace ambient::test
