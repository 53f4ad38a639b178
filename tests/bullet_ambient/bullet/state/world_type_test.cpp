#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

class WorldType : public testing::Test {
 protected:
  // The sentence that attach() refuses the world with; empty if it takes it.
  std::string refusal(const btDynamicsWorld& world) {
    AmbientRegistry registry;
    AttachDef def;
    def.fluid_body = std::make_shared<FluidBody>(facelessEllipsoid(Vector3::Ones()));
    def.medium = air();
    try {
      registry.attach(world, body_, def);
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(registry.size(), 0u);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    EXPECT_TRUE(registry.isAttached(body_));
    return {};
  }
  static void expectNames(const std::string& sentence, const char* refused, const char* advised) {
    EXPECT_NE(sentence.find(refused), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(advised), std::string::npos) << sentence;
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;

 private:
  btSphereShape shape_{1};
  btRigidBody body_{1, nullptr, &shape_, btVector3(1, 1, 1)};
};

TEST_F(WorldType, SimpleWorldsAreRefused) {
  btSequentialImpulseConstraintSolver solver;
  expectNames(refusal(btSimpleDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration)),
              "btSimpleDynamicsWorld", "btDiscreteDynamicsWorld");
}

TEST_F(WorldType, DeformableWorldsAreRefused) {
  btDeformableMultiBodyConstraintSolver solver;
  btDeformableBodySolver deformable;
  solver.setDeformableSolver(&deformable);
  expectNames(refusal(btDeformableMultiBodyDynamicsWorld(&dispatcher, &broadphase, &solver,
                                                         &configuration, &deformable)),
              "btDeformableMultiBodyDynamicsWorld", "btSoftRigidDynamicsWorld");
}

TEST_F(WorldType, TheOthersAreTaken) {
  btSequentialImpulseConstraintSolver solver;
  btMultiBodyConstraintSolver multibody_solver;
  EXPECT_EQ(refusal(btDiscreteDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration)),
            "");
  EXPECT_EQ(refusal(btMultiBodyDynamicsWorld(&dispatcher, &broadphase, &multibody_solver,
                                             &configuration)),
            "");
  EXPECT_EQ(refusal(btSoftRigidDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration)),
            "");
}

}  // namespace
}  // namespace ambient::test
