#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <new>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/world_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

constexpr double kTimeStep = 1.0 / 60;

FluidBody ball() { return meshedEllipsoid(Vector3::Ones(), 1); }

AttachDef inWater() {
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(ball());
  def.medium = water();
  return def;
}

// A place in memory for one body after the other.
class BodyStorage {
 public:
  btRigidBody& construct(btCollisionShape& shape) {
    return *new (bytes_) btRigidBody(100, nullptr, &shape, btVector3(40, 40, 40));
  }
  // Leaves a pattern that no live body has.
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
  Lifetime() {
    fluid.registry.setReport([](const std::string&) {});
    fluid.world.setGravity({0, 0, -8});
  }
  btRigidBody& addAttached() {
    btRigidBody& body = storage.construct(shape);
    fluid.world.addRigidBody(&body);
    fluid.registry.attach(body, inWater());
    return body;
  }
  void removeAndDestroy(btRigidBody& body) {
    fluid.world.removeRigidBody(&body);
    storage.destroy(body);
  }

  btSphereShape shape{1};
  BodyStorage storage;
  FluidWorld fluid;
};

TEST_F(Lifetime, NothingTouchesABodyThatWasDestroyedWhileAttached) {
  fluid.add({}, ball(), water());
  btRigidBody& body = addAttached();
  fluid.step(kTimeStep, 3);
  removeAndDestroy(body);
  fluid.step(kTimeStep, 3);
  EXPECT_TRUE(storage.isUntouched());
}

TEST_F(Lifetime, NothingTouchesABodyThatFlewWithoutTheActionAndWasDestroyed) {
  btRigidBody& body = addAttached();
  fluid.world.removeAction(&fluid.action);
  fluid.step(kTimeStep);
  removeAndDestroy(body);
  fluid.world.addAction(&fluid.action);
  fluid.step(kTimeStep);
  EXPECT_TRUE(storage.isUntouched());
}

// Between the solver's turn and that of our action.
TEST_F(Lifetime, NothingTouchesABodyThatAnotherActionHasDestroyed) {
  struct Destroyer : btActionInterface {
    void updateAction(btCollisionWorld* world, btScalar) override {
      if (body) {
        static_cast<btDynamicsWorld*>(world)->removeRigidBody(body);
        storage->destroy(*body);
      }
      body = nullptr;
    }
    void debugDraw(btIDebugDraw*) override {}
    btRigidBody* body = nullptr;
    BodyStorage* storage = nullptr;
  } destroyer;
  const btRigidBody& other = fluid.add({}, ball(), water());
  destroyer.body = &addAttached();
  destroyer.storage = &storage;
  fluid.world.removeAction(&fluid.action);
  fluid.world.addAction(&destroyer);
  fluid.world.addAction(&fluid.action);
  fluid.step(kTimeStep);
  EXPECT_TRUE(storage.isUntouched());
  // The removal moved the other body within the world's array; its flight was completed all the
  // same.
  EXPECT_EQ(bodiesOf(fluid.registry).find(&other)->outcome.kind, Outcome::kNotMet);
  fluid.world.removeAction(&destroyer);
}

// Of three that the solver has met, whichever it is.
TEST_F(Lifetime, ABodyThatAnotherActionDetachesLeavesTheOthersTheirFlights) {
  struct Detacher : btActionInterface {
    void updateAction(btCollisionWorld*, btScalar) override { registry->detach(*body); }
    void debugDraw(btIDebugDraw*) override {}
    AmbientRegistry* registry = nullptr;
    const btRigidBody* body = nullptr;
  } detacher;
  for (int detached = 0; detached < 3; ++detached) {
    FluidWorld three;
    three.world.setGravity({0, 0, -1});
    const btRigidBody* bodies[3];
    for (const btRigidBody*& body : bodies) body = &three.add({}, ball(), water());
    detacher.registry = &three.registry;
    detacher.body = bodies[detached];
    three.world.removeAction(&three.action);
    three.world.addAction(&detacher);
    three.world.addAction(&three.action);
    three.step(kTimeStep);
    for (int i = 0; i < 3; ++i) {
      const AmbientBody* ambient = bodiesOf(three.registry).find(bodies[i]);
      ASSERT_EQ(ambient == nullptr, i == detached);
      if (ambient) {
        EXPECT_EQ(ambient->outcome.kind, Outcome::kNotMet);
        EXPECT_NE(bodies[i]->getLinearVelocity().z(), 0);
      }
    }
    three.world.removeAction(&detacher);
  }
}

TEST_F(Lifetime, ANewBodyAtTheAddressOfADestroyedOneIsNotAttached) {
  removeAndDestroy(addAttached());
  btRigidBody& body = storage.construct(shape);
  ASSERT_EQ(static_cast<void*>(&body), storage.address());
  fluid.world.addRigidBody(&body);
  EXPECT_FALSE(fluid.registry.isAttached(body));
  EXPECT_THROW(fluid.registry.setMedium(body, air()), std::invalid_argument);
  fluid.step(kTimeStep);
  // As in a vacuum: in water it would rise.
  EXPECT_EQ(body.getLinearVelocity().z(), static_cast<btScalar>(kTimeStep) * -8);
  fluid.world.removeRigidBody(&body);
}

TEST_F(Lifetime, ANewBodyReplacesTheDestroyedOneWhenItIsAttached) {
  removeAndDestroy(addAttached());
  btRigidBody& body = addAttached();
  EXPECT_TRUE(fluid.registry.isAttached(body));
  EXPECT_EQ(fluid.registry.size(), 1u);
  fluid.step(kTimeStep);
  EXPECT_GT(body.getLinearVelocity().z(), 0);
  EXPECT_TRUE(fluid.registry.detach(body));
  EXPECT_EQ(fluid.registry.size(), 0u);
  fluid.world.removeRigidBody(&body);
}

TEST_F(Lifetime, AnObjectOfAnotherKindAtTheAddressIsNotAttached) {
  removeAndDestroy(addAttached());
  auto* object = new (storage.address()) btCollisionObject;
  object->setCollisionShape(&shape);
  fluid.world.addCollisionObject(object);
  EXPECT_EQ(bodiesOf(fluid.registry).find(object), nullptr);
  fluid.step(kTimeStep);
  fluid.world.removeCollisionObject(object);
  object->~btCollisionObject();
}

TEST_F(Lifetime, ABodyCanBeDetachedAfterItWasDestroyed) {
  btRigidBody& body = addAttached();
  removeAndDestroy(body);
  EXPECT_TRUE(fluid.registry.detach(body));
  EXPECT_FALSE(fluid.registry.detach(body));
  EXPECT_TRUE(storage.isUntouched());
}

TEST_F(Lifetime, ARemovedBodyKeepsItsFluidAndMeetsItAgain) {
  btRigidBody& body = addAttached();
  fluid.world.removeRigidBody(&body);
  fluid.step(kTimeStep);
  EXPECT_EQ(body.getLinearVelocity().z(), 0);
  fluid.world.addRigidBody(&body);
  fluid.step(kTimeStep);
  EXPECT_GT(body.getLinearVelocity().z(), 0);
  fluid.world.removeRigidBody(&body);
}

// Nothing may be left of the fluid body that it had before, until it is dynamic and stepped again.
TEST_F(Lifetime, AStaticBodyHasTheModelOfItsNewFluidBody) {
  btRigidBody& body = addAttached();
  body.setMassProps(0, btVector3(0, 0, 0));
  fluid.registry.setFluidBody(body, std::make_shared<FluidBody>(scaled(ball(), 2)));
  const WorldState state = saveState(fluid.world, fluid.registry);
  restoreState(state, fluid.world, fluid.registry);
  const AmbientBody& ambient = *bodiesOf(fluid.registry).find(&body);
  const auto loads = makeSurfaceLoads(ambient.def.fluid_body, water(), ambient.def.flow,
                                      bodiesOf(fluid.registry).load_tables);
  const Twist twist{{1, 2, 3}, {3, 1, 2}};
  EXPECT_EQ(ambient.model.loads->load(twist).vector(), loads->load(twist).vector());
  EXPECT_TRUE(fluid.registry.inertia(body).allFinite());
  EXPECT_NEAR(ambient.model.displaced_mass, water().density * 8 * ball().volume, 1e-6);
  fluid.world.removeRigidBody(&body);
}

TEST_F(Lifetime, TheFluidMayChangeWhileTheBodyIsStatic) {
  btRigidBody& body = addAttached();
  const btVector3 moments = body.getLocalInertia();
  fluid.world.removeRigidBody(&body);
  body.setMassProps(0, btVector3(0, 0, 0));
  Medium oil = water();
  oil.density = 800;
  fluid.registry.setMedium(body, oil);
  body.setMassProps(100, moments);
  fluid.world.addRigidBody(&body);
  fluid.step(kTimeStep);
  const double added = 800 * ball().added_mass(3, 3);
  EXPECT_NEAR(fluid.registry.inertia(body)(3, 3), 100 + added, 1e-6 * added);
  fluid.world.removeRigidBody(&body);
}

}  // namespace
}  // namespace ambient::test
