#include <LinearMath/btTransformUtil.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <iterator>
#include <list>
#include <map>
#include <memory>
#include <new>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/saved_state.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"

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
  EXPECT_EQ(ambientBodiesOf(scene.fluid).find(&other)->outcome.kind, Outcome::kNotSolved);
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
      const AmbientBody* ambient = ambientBodiesOf(three.fluid).find(bodies[i]);
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
  EXPECT_EQ(ambientBodiesOf(scene.fluid).find(object), nullptr);
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
  const AmbientBody& ambient = *ambientBodiesOf(scene.fluid).find(&body);
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
  return {60 * s * s * s, s * s * s * s * s * Vector3(0.9, 1.2, 1.9),
          startWith({Vector3(1, 2, -0.5), s * Vector3(0.4, -0.3, 0.2)})};
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
  const auto loads = ambientBodiesOf(scene.fluid).find(&body)->model().loads;
  EXPECT_THROW(scene.of(body).setFluidBody(nullptr), std::invalid_argument);
  auto broken = std::make_shared<FluidBody>(*plate().fluid_body);
  broken->added_mass(3, 3) = -1e6;
  EXPECT_THROW(scene.of(body).setFluidBody(broken), std::invalid_argument);
  EXPECT_EQ(scene.of(body).inertia(), before);
  EXPECT_EQ(ambientBodiesOf(scene.fluid).find(&body)->model().loads, loads);
  scene.step(kShortStep);
}

// Addresses at the distance of Bullet's bodies, none of which is read.
const btCollisionObject* addressOf(int number) {
  return reinterpret_cast<const btCollisionObject*>(std::uintptr_t{704} * number + 4096);
}

TEST(BodyIndex, FindsWhatWasInsertedAndNotErased) {
  constexpr int kAddresses = 300;
  Arbitrary arbitrary(1);
  std::list<AmbientBody> bodies;
  std::map<int, BodyIndex::Iterator> known;
  BodyIndex index;
  EXPECT_FALSE(index.find(addressOf(0)));
  for (int i = 0; i < 5000; ++i) {
    const int number = static_cast<int>(arbitrary.between(0, kAddresses));
    const auto found = known.find(number);
    if (found == known.end()) {
      bodies.emplace_back();
      index.insert(addressOf(number), std::prev(bodies.end()));
      known[number] = std::prev(bodies.end());
    } else {
      index.erase(addressOf(number));
      bodies.erase(found->second);
      known.erase(found);
    }
    if (i % 50 != 0) continue;
    for (int other = 0; other < kAddresses; ++other) {
      const auto place = index.find(addressOf(other));
      const auto expected = known.find(other);
      ASSERT_EQ(place.has_value(), expected != known.end()) << i << ' ' << other;
      if (place) {
        ASSERT_EQ(*place, expected->second) << i << ' ' << other;
      }
    }
  }
  EXPECT_GT(known.size(), 100U);
  index.clear();
  EXPECT_FALSE(index.find(addressOf(1)));
}

TEST(StartStates, AreTheStatesOfSingleBodies) {
  Arbitrary arbitrary(1);
  btSphereShape sphere(1);
  std::deque<btRigidBody> rigid;
  std::deque<AmbientBody> ambient(kFlightsTogether);
  AmbientBody* bodies[kFlightsTogether];
  for (int i = 0; i < kFlightsTogether; ++i) {
    btRigidBody& body = rigid.emplace_back(1, nullptr, &sphere, btVector3(1, 1, 1));
    body.setWorldTransform(
        btTransform(toBullet(Quaternion(arbitrary.rotation())), toBullet(arbitrary.vector(3))));
    body.setAngularVelocity(toBullet(arbitrary.vector(5)));
    body.setLinearVelocity(toBullet(arbitrary.vector(5)));
    body.applyCentralForce(toBullet(arbitrary.vector()));
    bodies[i] = &ambient[static_cast<std::size_t>(i)];
    bodies[i]->body = &body;
  }
  const double rounding = byPrecision(1e-14, 1e-6);
  for (const int count : {1, 5, kFlightsTogether}) {
    StartStates departures;
    readStartStates(bodies, count, departures);
    for (int i = 0; i < count; ++i) {
      const RigidState &state = departures.states[i], expected = readState(*bodies[i]->body);
      EXPECT_LT((state.orientation.toRotationMatrix() - expected.orientation.toRotationMatrix())
                    .cwiseAbs()
                    .maxCoeff(),
                rounding);
      EXPECT_EQ(state.position, expected.position);
      EXPECT_LT((state.twist.vector() - expected.twist.vector()).norm(), 20 * rounding);
      EXPECT_EQ(departures.twists_W[i].vector(), ambient::velocityOf(*bodies[i]->body).vector());
      EXPECT_EQ(departures.surroundings[i].applied.force,
                toVector3(bodies[i]->body->getTotalForce()));
    }
  }
}

// Attitudes to which Bullet turns bodies, by our sine and cosine.

TEST(Attitudes, AreThoseOfBulletsIntegration) {
  Arbitrary arbitrary(3);
  for (const double turn : {1e-9, 1e-4, 0.01, 0.3, 0.78, 0.8, 1.5, 6.0, 40.0}) {
    const Quaternion from =
        Quaternion(0.5, arbitrary.vector().x(), arbitrary.vector().y(), 0.3).normalized();
    const Vector3 spin = 60 * turn * arbitrary.vector().normalized();  // [rad/s]
    btTransform to;
    btTransformUtil::integrateTransform(btTransform(toBullet(from)), btVector3(0, 0, 0),
                                        toBullet(spin), bt(1.0 / 60), to);
    const Quaternion ours = turnedByBullet(from, spin / 60);
    EXPECT_LT(ours.angularDistance(toQuaternion(to.getRotation())), byPrecision(1e-7, 2e-3))
        << turn;
  }
}

TEST(Attitudes, AreSettledUnlessOthersHaveTurnedTheBody) {
  FluidWorld scene;
  btRigidBody& body = scene.add(BodyDef{});
  const Quaternion near(1, byPrecision(1e-12, 1e-6), 0, 0), far(1, 0.01, 0, 0);
  body.setLinearVelocity({1, 2, 3});
  settleAttitude(body, near.normalized());
  EXPECT_NE(body.getWorldTransform().getBasis()[2][1], bt(0));
  EXPECT_EQ(body.getInterpolationWorldTransform(), body.getWorldTransform());
  const btTransform before = body.getWorldTransform();
  settleAttitude(body, far.normalized());
  EXPECT_EQ(body.getWorldTransform(), before);
}

TEST(Attitudes, OfABodyThatWasStoppedAreThoseOfItsWay) {
  FluidWorld scene;
  btRigidBody& body = scene.add({1, ellipsoidMoments(Vector3::Constant(0.1), 1),
                                 startWith({Vector3(6, 0, 0), Vector3(60, 0, 0)})},
                                facelessEllipsoid(Vector3::Constant(0.1)), idealFluid(1));
  // Stops the body in the middle of its way, as continuous collision detection does.
  const btTransform start = body.getWorldTransform();
  const OtherAction stop(scene, [&] {
    btTransform half;
    btTransformUtil::integrateTransform(start, body.getLinearVelocity(), body.getAngularVelocity(),
                                        bt(kWorldStep / 2), half);
    body.proceedToTransform(half);
  });
  scene.step(kWorldStep);
  const btTransform& pose = body.getWorldTransform();
  EXPECT_NEAR(static_cast<double>(pose.getOrigin().x()), 30 * kWorldStep, byPrecision(1e-12, 1e-6));
  const double turned = 3 * kWorldStep;
  EXPECT_LT(toQuaternion(pose.getRotation())
                .angularDistance(Quaternion(Eigen::AngleAxisd(turned, Vector3(1, 0, 0)))),
            byPrecision(1e-7, 1e-3));
  EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().x()), 6, byPrecision(1e-12, 1e-5));
}

}  // namespace
}  // namespace ambient::test
