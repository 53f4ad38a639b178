#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "tests/bullet/fluid_world.h"

// What is not in a fluid moves bit for bit as in stock Bullet.
namespace ambient::test {
namespace {

// A world whose bodies, shapes and joints are made by a function, the same way each time.
class Scene {
 public:
  explicit Scene(bool with_ambient_solver) {
    btConstraintSolver* solver = with_ambient_solver ? static_cast<btConstraintSolver*>(&ambient_)
                                                     : static_cast<btConstraintSolver*>(&stock_);
    world = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver,
                                                      &configuration_);
    world->setGravity({0, 0, static_cast<btScalar>(-9.81)});
    if (with_ambient_solver) world->addAction(&action);
    addFloor();
    addStack();
    addJoints();
  }
  ~Scene() {
    for (const auto& joint : joints_) world->removeConstraint(joint.get());
    for (const auto& body : bodies) world->removeRigidBody(body.get());
  }

  btRigidBody& addBall(const btVector3& position) { return add(2, ball_, position); }
  void step(int count) {
    for (int i = 0; i < count; ++i) world->stepSimulation(dt_, 0, dt_);
  }

  AmbientRegistry registry;
  AmbientAction action{registry};
  std::unique_ptr<btDiscreteDynamicsWorld> world;
  std::vector<std::unique_ptr<btRigidBody>> bodies;

 private:
  btRigidBody& add(btScalar mass, btCollisionShape& shape, const btVector3& position) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    bodies.push_back(std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(mass, nullptr, &shape, inertia)));
    bodies.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), position));
    world->addRigidBody(bodies.back().get());
    return *bodies.back();
  }
  void addFloor() { add(0, floor_, {0, 0, -1}).setRestitution(static_cast<btScalar>(0.3)); }
  void addStack() {
    for (int i = 0; i < 5; ++i) add(1, box_, {0, 0, static_cast<btScalar>(0.6 + 1.1 * i)});
    btRigidBody& ball = addBall({-6, static_cast<btScalar>(0.1), 2});
    ball.setLinearVelocity({9, 0, 1});
    ball.setRestitution(static_cast<btScalar>(0.5));
    ball.setRollingFriction(static_cast<btScalar>(0.01));
  }
  void addJoints() {
    const btVector3 up(0, 0, static_cast<btScalar>(0.7));
    const btTransform frame(btQuaternion::getIdentity(), up);
    for (int kind = 0; kind < 5; ++kind) {
      btRigidBody& body = add(1, box_, {static_cast<btScalar>(4 + 3 * kind), 6, 4});
      body.setAngularVelocity({1, 2, static_cast<btScalar>(0.5)});
      if (kind == 0) keep(new btPoint2PointConstraint(body, up));
      if (kind == 1) {
        auto* hinge = new btHingeConstraint(body, up, btVector3(0, 1, 0));
        hinge->enableAngularMotor(true, 2, static_cast<btScalar>(0.1));
        keep(hinge);
      }
      if (kind == 2) keep(new btSliderConstraint(body, frame, true));
      if (kind == 3) keep(new btConeTwistConstraint(body, frame));
      if (kind == 4) {
        auto* spring = new btGeneric6DofSpring2Constraint(body, frame);
        spring->enableSpring(2, true);
        spring->setStiffness(2, 50);
        keep(spring);
      }
    }
  }
  void keep(btTypedConstraint* joint) {
    joints_.emplace_back(joint);
    world->addConstraint(joint);
  }

  const btScalar dt_ = static_cast<btScalar>(1.0 / 120);
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver stock_;
  AmbientSolver<> ambient_{registry};
  btBoxShape floor_{btVector3(50, 50, 1)};
  btBoxShape box_{btVector3(static_cast<btScalar>(0.5), static_cast<btScalar>(0.5),
                            static_cast<btScalar>(0.5))};
  btSphereShape ball_{static_cast<btScalar>(0.4)};
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

bool sameBits(const btRigidBody& a, const btRigidBody& b) {
  btTransformData pose_a, pose_b;
  a.getWorldTransform().serialize(pose_a);
  b.getWorldTransform().serialize(pose_b);
  return std::memcmp(&pose_a, &pose_b, sizeof(pose_a)) == 0 &&
         a.getLinearVelocity() == b.getLinearVelocity() &&
         a.getAngularVelocity() == b.getAngularVelocity();
}

void expectSameMotion(Scene& stock, Scene& ambient) {
  for (int step = 0; step < 700; step += 70) {
    stock.step(70);
    ambient.step(70);
    for (std::size_t i = 0; i < stock.bodies.size(); ++i) {
      if (ambient.registry.isAttached(*ambient.bodies[i]) &&
          ambient.registry.medium(*ambient.bodies[i]).density > 0) {
        continue;
      }
      ASSERT_TRUE(sameBits(*stock.bodies[i], *ambient.bodies[i]))
          << "body " << i << " at step " << step;
    }
  }
  // The scene is one in which things happen: something has moved by more than a metre.
  EXPECT_GT((stock.bodies[6]->getWorldTransform().getOrigin() - btVector3(-6, 0, 2)).length(), 1);
}

TEST(StockMotion, OfAWorldWithoutAmbientBodiesIsKeptBitForBit) {
  Scene stock(false), ambient(true);
  expectSameMotion(stock, ambient);
}

TEST(StockMotion, OfBodiesBesideAmbientOnesIsKeptBitForBit) {
  Scene stock(false), ambient(true);
  for (Scene* scene : {&stock, &ambient}) {
    btRigidBody& far = scene->addBall({0, 0, 500});
    far.setAngularVelocity({1, 2, 3});
    if (scene == &stock) continue;
    scene->registry.attach(
        far,
        {std::make_shared<FluidBody>(meshedEllipsoid(Vector3(1, 1, 0.5), 1)), air(), {}, {}, {}});
  }
  expectSameMotion(stock, ambient);
  EXPECT_GT(ambient.registry.counters().load_evaluations, 0);
}

TEST(StockMotion, OfBodiesInAFluidOfDensityZeroIsKeptBitForBit) {
  Scene stock(false), ambient(true);
  const auto shape = std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.5, 0.5, 0.5), 1));
  for (std::size_t i = 1; i < ambient.bodies.size(); ++i) {
    ambient.registry.attach(*ambient.bodies[i], {shape, Medium{}, {}, {}, {}});
  }
  expectSameMotion(stock, ambient);
  EXPECT_EQ(ambient.registry.counters().load_evaluations, 0);
}

TEST(StockMotion, ReturnsWhenABodyIsDetached) {
  Scene stock(false), ambient(true);
  const auto shape = std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.5, 0.5, 0.5), 1));
  ambient.registry.attach(*ambient.bodies[3], {shape, water(), {}, {}, {}});
  EXPECT_TRUE(ambient.registry.detach(*ambient.bodies[3]));
  EXPECT_FALSE(ambient.registry.detach(*ambient.bodies[3]));
  expectSameMotion(stock, ambient);
}

}  // namespace
}  // namespace ambient::test
