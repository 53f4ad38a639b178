#include <gtest/gtest.h>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

constexpr double kShortStep = 1.0 / 120;
constexpr double kScale = 2.5;

// A flat ellipsoid whose fluid frame is shifted and turned, so that everything couples.
AttachDef plate() {
  AttachDef def;
  auto shape = std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.3, 0.25, 0.1), 2));
  shape->centre_of_volume = Vector3(0.02, -0.01, 0.005);
  def.fluid_body = shape;
  def.medium = {500, 0.2, Vector3(0.1, 0.2, 0), Vector3::Zero()};
  def.flow.precision = LoadPrecision::kDouble;  // 2.5 is no power of two
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

// Lengths s, times 1: Reynolds and Froude numbers stay with viscosity s^2 and gravity s.
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

void fly(FluidWorld& fluid, btRigidBody& body, double s) {
  body.setGravity(btVector3(0, 0, static_cast<btScalar>(-9.81 * s)));
  fluid.step(kShortStep, 60);
}

Motion flightOfScale(double s) {
  FluidWorld fluid;
  AttachDef def = plate();
  def.medium = scaledMedium(def.medium, s);
  def.fluid_body = std::make_shared<FluidBody>(scaled(*def.fluid_body, s));
  def.fluid_frame.translation *= s;
  btRigidBody& body = fluid.add(plateBody(s));
  fluid.registry.attach(body, def);
  fly(fluid, body, s);
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
  FluidWorld fluid;
  btRigidBody& body = fluid.add(plateBody(kScale));
  const BodyDef unit = plateBody(1);
  body.setMassProps(static_cast<btScalar>(unit.mass), toBullet(unit.moments));
  AttachDef def = plate();
  fluid.registry.attach(body, def);

  const BodyDef large = plateBody(kScale);
  body.setMassProps(static_cast<btScalar>(large.mass), toBullet(large.moments));
  FrameOffset frame = def.fluid_frame;
  frame.translation *= kScale;
  fluid.registry.setFluidBody(body, std::make_shared<FluidBody>(scaled(*def.fluid_body, kScale)),
                              frame);
  fluid.registry.setMedium(body, scaledMedium(def.medium, kScale));
  fly(fluid, body, kScale);
  expectScaled(motionOf(body), flightOfScale(1));
}

TEST(ShapeScaling, ARefusedFluidBodyLeavesTheOldOne) {
  FluidWorld fluid;
  btRigidBody& body = fluid.add(plateBody(1));
  fluid.registry.attach(body, plate());
  const Matrix6 before = fluid.registry.inertia(body);
  const auto loads = bodiesOf(fluid.registry).find(&body)->model.loads;
  EXPECT_THROW(fluid.registry.setFluidBody(body, nullptr), std::invalid_argument);
  auto broken = std::make_shared<FluidBody>(*plate().fluid_body);
  broken->added_mass(3, 3) = -1e6;
  EXPECT_THROW(fluid.registry.setFluidBody(body, broken), std::invalid_argument);
  EXPECT_EQ(fluid.registry.inertia(body), before);
  EXPECT_EQ(bodiesOf(fluid.registry).find(&body)->model.loads, loads);
  fluid.step(kShortStep);
}

}  // namespace
}  // namespace ambient::test
