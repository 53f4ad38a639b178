#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/worlds/world_setups.h"
#include "tests/support/bodies/free_body.h"

// Soft bodies touch rigid ones after solver and actions, by btRigidBody::applyImpulse(). These
// impulses use the dry mass and inertia, for ambient bodies, too. K acts in the rigid part of the
// next step.
namespace ambient::test {
namespace {

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
