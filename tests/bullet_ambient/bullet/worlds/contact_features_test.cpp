// Bullet's features for a body of coupled K: kinematic bodies, locked axes, compound shapes,
// filters, continuous collision, forces at points and damping.

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/worlds/world_setups.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

/// One body with a coupled K in an ideal fluid, colliding as a sphere about the centre of mass.
/// World without gravity and without position correction.
class CoupledScene {
 public:
  static constexpr double kRadius = 0.25;

  explicit CoupledScene(unsigned seed, double fluid_ratio = 3)
      : arbitrary(seed), coupled(CoupledBody::random(arbitrary, fluid_ratio)) {
    body().setCollisionShape(&ball_);
    body().setActivationState(DISABLE_DEACTIVATION);
    body().setFriction(0);
    btContactSolverInfo& info = scene.world.getSolverInfo();
    info.m_splitImpulse = 0;
    info.m_erp = info.m_erp2 = 0;
    info.m_restitutionVelocityThreshold = 0;
    info.m_numIterations = 500;
    scene.world.addRigidBody(&body());
    coupled.attachTo(ambientBodiesOf(scene.fluid));
  }
  ~CoupledScene() { scene.world.removeRigidBody(&body()); }

  btRigidBody& body() { return coupled.body(); }
  void stop() {
    body().setLinearVelocity({0, 0, 0});
    body().setAngularVelocity({0, 0, 0});
  }
  /// Steps without the action: velocities stay equal to the rows' solution.
  void solve(double duration) {
    scene.removeAction();
    scene.step(duration);
    scene.addAction();
  }
  Arbitrary arbitrary;
  CoupledBody coupled;
  FluidWorld scene;

 private:
  btSphereShape ball_{static_cast<btScalar>(kRadius)};
};

reference::DenseBody fixedBody() {
  reference::DenseBody result;
  result.fixed = true;
  return result;
}

TEST(ContactFeatures, AKinematicBodyPushesWithItsVelocity) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    CoupledScene scene(seed);
    scene.stop();
    const double speed = 1.5, half = 0.1;
    btTransform pose = scene.body().getWorldTransform();
    pose.setOrigin({bt(half + CoupledScene::kRadius - 1e-3), 0, 0});
    scene.body().setCenterOfMassTransform(pose);
    btBoxShape box(btVector3(bt(half), 1, 1));
    btRigidBody paddle(0, nullptr, &box);
    paddle.setFriction(0);
    paddle.setCollisionFlags(paddle.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    paddle.setActivationState(DISABLE_DEACTIVATION);
    scene.scene.world.addRigidBody(&paddle);
    const double dt = 1.0 / 128;
    paddle.setWorldTransform(
        btTransform(btQuaternion::getIdentity(), btVector3(bt(speed * dt), 0, 0)));
    const Vector3r x(1, 0, 0);
    reference::DenseRow row = reference::pointRow(x, -Real(CoupledScene::kRadius) * x, x);
    row.target = speed;
    row.lower = 0;
    const auto expected = reference::solveDense({scene.coupled.dense(dt), fixedBody()}, {row});
    scene.solve(dt);
    EXPECT_GT(expected.velocities[0].norm(), 1.4);
    EXPECT_LT(scene.coupled.error(expected.velocities[0], expected.velocities[0]), kTolerance);
    scene.scene.world.removeRigidBody(&paddle);
  }
}

// Speed of a ball that moves along y only, pushed out of an overlapping wall. The wall's normal is
// at an angle to the locked x; Bullet pushes along the normal.
double speedOfPush(double angle, bool in_fluid) {
  constexpr double kDepth = 1e-3;
  FluidWorld scene;
  scene.world.getSolverInfo().m_splitImpulse = 0;
  btStaticPlaneShape plane({bt(std::cos(angle)), bt(std::sin(angle)), 0}, 0);
  scene.contents.add(0, plane).setFriction(0);
  btSphereShape ball(bt(0.2));
  BodyDef def{1, Vector3::Constant(0.016),
              startAt((0.2 - kDepth) * Vector3(std::cos(angle), std::sin(angle), 0)), &ball};
  Vector6 added;
  added << 0.01, 0.02, 0.03, 1, 2, 3;
  FluidBody shape;
  shape.name = "uneven";
  shape.added_mass = added.asDiagonal();
  btRigidBody& body = in_fluid ? scene.add(def, shape, idealFluid(1)) : scene.add(def);
  body.setLinearFactor({0, 1, 0});
  body.setAngularFactor(0);
  scene.step(kWorldStep);
  EXPECT_EQ(scene.fluid.counters().rows > 0, in_fluid);
  return static_cast<double>(body.getLinearVelocity().y());
}

// The normal's part along the free axis is a small lever. In float its square, 1e-4 of the whole,
// has three digits.
TEST(ContactFeatures, AContactAlmostAlongALockedAxisPushesAsInStockBullet) {
  for (const double angle : {1.5, 0.5, 0.1, 0.01}) {
    const double stock = speedOfPush(angle, false);
    EXPECT_GT(stock, 0) << angle;
    EXPECT_NEAR(speedOfPush(angle, true) / stock, 1, byPrecision(1e-9, 1e-3)) << angle;
  }
}

// Position and velocity after half a second of flight towards a wall.
Vector6 flightTowardsAWall(bool is_wall_there, int mask) {
  CoupledScene scene(3);
  scene.body().setLinearVelocity({4, 0, 0});
  btTransform pose = scene.body().getWorldTransform();
  pose.setOrigin({0, 0, 0});
  scene.body().setWorldTransform(pose);
  scene.scene.world.removeRigidBody(&scene.body());
  scene.scene.world.addRigidBody(&scene.body(), 2, mask);
  btBoxShape box(btVector3(bt(0.1), 5, 5));
  btRigidBody wall(0, nullptr, &box);
  wall.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(1, 0, 0)));
  if (is_wall_there) scene.scene.world.addRigidBody(&wall, 4, -1);
  scene.scene.step(1.0 / 120, 60);
  const Vector6 state = stack(toVector3(scene.body().getWorldTransform().getOrigin()),
                              toVector3(scene.body().getLinearVelocity()));
  if (is_wall_there) scene.scene.world.removeRigidBody(&wall);
  return state;
}

TEST(ContactFeatures, FiltersLetABodyThroughOrNot) {
  const Vector6 free = flightTowardsAWall(false, -1);
  EXPECT_GT(free[0], 1.2);
  EXPECT_EQ(flightTowardsAWall(true, -1 & ~4), free);
  EXPECT_LT(flightTowardsAWall(true, -1)[0], 1 - 0.1 - CoupledScene::kRadius + 0.01);
}

constexpr double kSweptRadius = 0.2, kCcdThreshold = 0.1;
constexpr double kWallSurface = 3.45;

// Farthest place of a body that flies towards a thin wall by more than its size per step.
double flyFast(unsigned seed, double speed, bool is_continuous) {
  CoupledScene scene(seed);
  btContactSolverInfo& info = scene.scene.world.getSolverInfo();
  info.m_erp = info.m_erp2 = bt(0.2);
  scene.body().setAngularVelocity(btVector3(1, 2, 3) * bt(seed % 2 == 0 ? 1 : 50));
  scene.body().setLinearVelocity({bt(speed), 0, 0});
  btTransform pose = scene.body().getWorldTransform();
  pose.setOrigin({0, 0, 0});
  scene.body().setWorldTransform(pose);
  btBoxShape box(btVector3(bt(0.05), 50, 50));
  scene.scene.contents.add(
      0, box, btTransform(btQuaternion::getIdentity(), btVector3(bt(kWallSurface + 0.05), 0, 0)));
  if (is_continuous) {
    scene.body().setCcdMotionThreshold(bt(kCcdThreshold));
    scene.body().setCcdSweptSphereRadius(bt(kSweptRadius));
  }
  double farthest = 0;
  for (int i = 0; i < 30; ++i) {
    scene.scene.step(1.0 / 60);
    farthest =
        std::max(farthest, static_cast<double>(scene.body().getWorldTransform().getOrigin().x()));
  }
  return farthest;
}

TEST(ContactFeatures, ContinuousCollisionStopsAtTheWall) {
  for (const double speed : {60.0, 120.0}) {
    int tunnelled = 0;
    for (unsigned seed = 0; seed < 10; ++seed) {
      const double farthest = flyFast(seed, speed, true);
      EXPECT_GT(farthest, kWallSurface - CoupledScene::kRadius - 1e-3) << seed;
      // Motion below the threshold is not swept.
      EXPECT_LT(farthest, kWallSurface - kSweptRadius + kCcdThreshold) << seed;
      tunnelled += flyFast(seed, speed, false) > kWallSurface + 1;
    }
    EXPECT_GT(tunnelled, 3) << speed;
  }
}

TEST(ContactFeatures, DampingScalesTheVelocityBeforeEachStep) {
  const double dt = 1.0 / 128;
  CoupledScene damped(4), scaled(4);
  damped.body().setDamping(bt(0.3), bt(0.5));
  for (int i = 0; i < 128; ++i) {
    btRigidBody& body = scaled.body();
    body.setLinearVelocity(body.getLinearVelocity() * btPow(bt(0.7), bt(dt)));
    body.setAngularVelocity(body.getAngularVelocity() * btPow(bt(0.5), bt(dt)));
    damped.scene.step(dt);
    scaled.scene.step(dt);
  }
  const DenseVector6 expected = scaled.coupled.velocity();
  EXPECT_LT(damped.coupled.error(expected, expected), byPrecision(1e-12, 1e-4));
  EXPECT_LT(expected.norm(), 0.8 * CoupledScene(4).coupled.velocity().norm());
}

// Bullet's features of joints with a body of coupled K in an ideal fluid.

struct OnJoint : CoupledScene {
  explicit OnJoint(unsigned seed) : CoupledScene(seed) {
    stop();
    pivot = toBt(arbitrary.vector(0.5 * coupled.size()));
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
  btTransform pose() { return body().getWorldTransform(); }
  Vector3r arm() { return exact(pose().getBasis() * pivot); }

  btVector3 pivot;
  std::unique_ptr<btTypedConstraint> joint;
};

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
    AttachDef def{std::make_shared<FluidBody>(fluid_body)};
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
