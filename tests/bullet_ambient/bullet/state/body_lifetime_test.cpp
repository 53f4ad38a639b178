#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <new>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/saved_state.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

constexpr double kTimeStep = 1.0 / 60;

FluidBody unitBall() { return meshedEllipsoid(Vector3::Ones(), 1); }

// Memory for one body after another.
class BodyStorage {
 public:
  btRigidBody& construct(btCollisionShape& shape) {
    return *new (bytes_) btRigidBody(100, nullptr, &shape, btVector3(40, 40, 40));
  }
  // Destroys a body and leaves a pattern that no live body has.
  void destroy(btRigidBody& body) {
    body.~btRigidBody();
    std::memset(bytes_, 0xa5, sizeof bytes_);
  }
  bool isUntouched() const {
    for (const unsigned char byte : bytes_) {
      if (byte != 0xa5) return false;
    }
    return true;
  }
  void* address() { return bytes_; }

 private:
  alignas(16) unsigned char bytes_[sizeof(btRigidBody)];
};

class Lifetime : public testing::Test {
 protected:
  Lifetime() { scene.world.setGravity({0, 0, -8}); }
  btRigidBody& addAttached() {
    btRigidBody& body = storage.construct(shape);
    scene.world.addRigidBody(&body);
    scene.fluid.add(body, unitBallIn(water()));
    return body;
  }
  void removeAndDestroy(btRigidBody& body) {
    scene.world.removeRigidBody(&body);
    storage.destroy(body);
  }

  btSphereShape shape{1};
  BodyStorage storage;
  FluidWorld scene;
};

TEST_F(Lifetime, NothingTouchesABodyThatWasDestroyedWhileAttached) {
  scene.add({}, unitBall(), water());
  btRigidBody& body = addAttached();
  scene.step(kTimeStep, 3);
  removeAndDestroy(body);
  scene.step(kTimeStep, 3);
  EXPECT_TRUE(storage.isUntouched());
}

TEST_F(Lifetime, NothingTouchesABodyThatFlewWithoutTheActionAndWasDestroyed) {
  btRigidBody& body = addAttached();
  scene.removeAction();
  scene.step(kTimeStep);
  removeAndDestroy(body);
  scene.addAction();
  scene.step(kTimeStep);
  EXPECT_TRUE(storage.isUntouched());
}

// Destroys a body between the solver and the fluid's action.
TEST_F(Lifetime, NothingTouchesABodyThatAnotherActionHasDestroyed) {
  const btRigidBody& other = scene.add({}, unitBall(), water());
  btRigidBody& body = addAttached();
  const OtherAction destroy(scene, [&] {
    scene.world.removeRigidBody(&body);
    storage.destroy(body);
  });
  scene.step(kTimeStep);
  EXPECT_TRUE(storage.isUntouched());
  // The removal moved the other body within the world's array; its flight was completed all the
  // same.
  EXPECT_EQ(membersOf(scene.fluid).find(&other)->outcome.kind, Outcome::kNotSolved);
}

// Detaches one of three bodies that the solver has met.
TEST_F(Lifetime, ABodyThatAnotherActionDetachesLeavesTheOthersTheirFlights) {
  for (int detached = 0; detached < 3; ++detached) {
    FluidWorld three;
    three.world.setGravity({0, 0, -1});
    const btRigidBody* bodies[3];
    for (const btRigidBody*& body : bodies) body = &three.add({}, unitBall(), water());
    const OtherAction detach(three, [&] { three.of(*bodies[detached]).remove(); });
    three.step(kTimeStep);
    for (int i = 0; i < 3; ++i) {
      const AmbientBody* ambient = membersOf(three.fluid).find(bodies[i]);
      ASSERT_EQ(ambient == nullptr, i == detached);
      if (ambient) {
        EXPECT_EQ(ambient->outcome.kind, Outcome::kNotSolved);
        EXPECT_NE(bodies[i]->getLinearVelocity().z(), 0);
      }
    }
  }
}

TEST_F(Lifetime, ANewBodyAtTheAddressOfADestroyedOneIsNotAttached) {
  removeAndDestroy(addAttached());
  btRigidBody& body = storage.construct(shape);
  ASSERT_EQ(static_cast<void*>(&body), storage.address());
  scene.world.addRigidBody(&body);
  EXPECT_FALSE(scene.fluid.find(body));
  scene.step(kTimeStep);
  // As in a vacuum: in water it would rise.
  EXPECT_EQ(body.getLinearVelocity().z(), static_cast<btScalar>(kTimeStep) * -8);
  scene.world.removeRigidBody(&body);
}

TEST_F(Lifetime, ANewBodyReplacesTheDestroyedOneWhenItIsAttached) {
  btRigidBody& gone = addAttached();
  const Immersed first = scene.of(gone);
  removeAndDestroy(gone);
  btRigidBody& body = addAttached();
  EXPECT_FALSE(first.isValid());
  EXPECT_TRUE(scene.fluid.find(body));
  EXPECT_EQ(scene.fluid.size(), 1u);
  scene.step(kTimeStep);
  EXPECT_GT(body.getLinearVelocity().z(), 0);
  EXPECT_TRUE(scene.of(body).remove());
  EXPECT_EQ(scene.fluid.size(), 0u);
  scene.world.removeRigidBody(&body);
}

TEST_F(Lifetime, AnObjectOfAnotherKindAtTheAddressIsNotAttached) {
  removeAndDestroy(addAttached());
  auto* object = new (storage.address()) btCollisionObject;
  object->setCollisionShape(&shape);
  scene.world.addCollisionObject(object);
  EXPECT_EQ(membersOf(scene.fluid).find(object), nullptr);
  scene.step(kTimeStep);
  scene.world.removeCollisionObject(object);
  object->~btCollisionObject();
}

TEST_F(Lifetime, ABodyCanBeDetachedAfterItWasDestroyed) {
  btRigidBody& body = addAttached();
  const Immersed immersed = scene.of(body);
  removeAndDestroy(body);
  EXPECT_TRUE(immersed.remove());
  EXPECT_FALSE(immersed.remove());
  EXPECT_TRUE(storage.isUntouched());
}

TEST_F(Lifetime, ARemovedBodyKeepsItsFluidAndMeetsItAgain) {
  btRigidBody& body = addAttached();
  scene.world.removeRigidBody(&body);
  scene.step(kTimeStep);
  EXPECT_EQ(body.getLinearVelocity().z(), 0);
  scene.world.addRigidBody(&body);
  scene.step(kTimeStep);
  EXPECT_GT(body.getLinearVelocity().z(), 0);
  scene.world.removeRigidBody(&body);
}

// Model must follow the new fluid body, not the old one, once dynamic and stepped again.
TEST_F(Lifetime, AStaticBodyHasTheModelOfItsNewFluidBody) {
  btRigidBody& body = addAttached();
  body.setMassProps(0, btVector3(0, 0, 0));
  scene.of(body).setFluidBody(std::make_shared<FluidBody>(scaled(unitBall(), 2)));
  const WorldState state = scene.fluid.save();
  scene.fluid.restore(state);
  const AmbientBody& ambient = *membersOf(scene.fluid).find(&body);
  const auto loads = makeSurfaceLoads(ambient.def->fluid_body, water(), ambient.def->flow);
  const Twist twist{{1, 2, 3}, {3, 1, 2}};
  EXPECT_EQ(ambient.model().loads->load(twist).vector(), loads->load(twist).vector());
  EXPECT_TRUE(scene.of(body).inertia().allFinite());
  EXPECT_NEAR(ambient.model().displaced_mass, water().density * 8 * unitBall().volume, 1e-6);
  scene.world.removeRigidBody(&body);
}

TEST_F(Lifetime, TheFluidMayChangeWhileTheBodyIsStatic) {
  btRigidBody& body = addAttached();
  const btVector3 moments = body.getLocalInertia();
  scene.world.removeRigidBody(&body);
  body.setMassProps(0, btVector3(0, 0, 0));
  Medium oil = water();
  oil.density = 800;
  scene.of(body).setMedium(oil);
  body.setMassProps(100, moments);
  scene.world.addRigidBody(&body);
  scene.step(kTimeStep);
  const double added = 800 * unitBall().added_mass(3, 3);
  EXPECT_NEAR(scene.of(body).inertia()(3, 3), 100 + added, 1e-6 * added);
  scene.world.removeRigidBody(&body);
}

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
