#include <gtest/gtest.h>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

constexpr double kShortStep = 1.0 / 120;
constexpr double kScale = 2.5;

// A flat ellipsoid, its fluid frame shifted and turned: all motions couple.
AttachDef plate() {
  AttachDef def;
  auto shape = std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.3, 0.25, 0.1), 2));
  shape->centre_of_volume = Vector3(0.02, -0.01, 0.005);
  def.fluid_body = shape;
  def.medium = {500, 0.2, Vector3(0.1, 0.2, 0), Vector3::Zero()};
  def.flow.precision = LoadPrecision::kDouble;  // 2.5 is not a power of two
  def.fluid_frame.rotation = rotationFromVector(Vector3(0.3, 0.2, 0.5)).toRotationMatrix();
  def.fluid_frame.translation = Vector3(0.05, 0.02, -0.03);
  return def;
}

BodyDef plateBody(double s) {
  BodyDef def;
  def.mass = 60 * s * s * s;
  def.moments = s * s * s * s * s * Vector3(0.9, 1.2, 1.9);
  def.start.twist = {Vector3(1, 2, -0.5), s * Vector3(0.4, -0.3, 0.2)};
  return def;
}

// Medium for lengths s and times 1: viscosity s^2 and gravity s keep Reynolds and Froude numbers.
Medium scaledMedium(Medium medium, double s) {
  medium.viscosity *= s * s;
  medium.velocity *= s;
  return medium;
}

struct Motion {
  Vector3 position, linear, angular;
};

Motion motionOf(const btRigidBody& body) {
  return {toVector3(body.getWorldTransform().getOrigin()), toVector3(body.getLinearVelocity()),
          toVector3(body.getAngularVelocity())};
}

void fly(FluidWorld& scene, btRigidBody& body, double s) {
  body.setGravity(btVector3(0, 0, static_cast<btScalar>(-9.81 * s)));
  scene.step(kShortStep, 60);
}

Motion flightOfScale(double s) {
  FluidWorld scene;
  AttachDef def = plate();
  def.medium = scaledMedium(def.medium, s);
  def.fluid_body = std::make_shared<FluidBody>(scaled(*def.fluid_body, s));
  def.fluid_frame.translation *= s;
  btRigidBody& body = scene.add(plateBody(s));
  scene.fluid.add(body, def);
  fly(scene, body, s);
  return motionOf(body);
}

void expectScaled(const Motion& motion, const Motion& unit) {
  const double tolerance = byPrecision(2e-12, 1e-4);
  EXPECT_LT((motion.position - kScale * unit.position).norm(),
            tolerance * kScale * unit.position.norm());
  EXPECT_LT((motion.linear - kScale * unit.linear).norm(), tolerance * kScale * unit.linear.norm());
  EXPECT_LT((motion.angular - unit.angular).norm(), tolerance * unit.angular.norm());
}

TEST(ShapeScaling, AScaledBodyFliesTheScaledPath) {
  const Motion unit = flightOfScale(1);
  EXPECT_GT(unit.angular.norm(), 0.1);
  expectScaled(flightOfScale(kScale), unit);
}

TEST(ShapeScaling, AnAttachedBodyCanBeRescaled) {
  FluidWorld scene;
  btRigidBody& body = scene.add(plateBody(kScale));
  const BodyDef unit = plateBody(1);
  body.setMassProps(static_cast<btScalar>(unit.mass), toBullet(unit.moments));
  AttachDef def = plate();
  scene.fluid.add(body, def);

  const BodyDef large = plateBody(kScale);
  body.setMassProps(static_cast<btScalar>(large.mass), toBullet(large.moments));
  FrameOffset frame = def.fluid_frame;
  frame.translation *= kScale;
  scene.of(body).setFluidBody(std::make_shared<FluidBody>(scaled(*def.fluid_body, kScale)), frame);
  scene.of(body).setMedium(scaledMedium(def.medium, kScale));
  fly(scene, body, kScale);
  expectScaled(motionOf(body), flightOfScale(1));
}

TEST(ShapeScaling, ARefusedFluidBodyLeavesTheOldOne) {
  FluidWorld scene;
  btRigidBody& body = scene.add(plateBody(1));
  scene.fluid.add(body, plate());
  const Matrix6 before = scene.of(body).inertia();
  const auto loads = membersOf(scene.fluid).find(&body)->model().loads;
  EXPECT_THROW(scene.of(body).setFluidBody(nullptr), std::invalid_argument);
  auto broken = std::make_shared<FluidBody>(*plate().fluid_body);
  broken->added_mass(3, 3) = -1e6;
  EXPECT_THROW(scene.of(body).setFluidBody(broken), std::invalid_argument);
  EXPECT_EQ(scene.of(body).inertia(), before);
  EXPECT_EQ(membersOf(scene.fluid).find(&body)->model().loads, loads);
  scene.step(kShortStep);
}

}  // namespace
}  // namespace ambient::test
