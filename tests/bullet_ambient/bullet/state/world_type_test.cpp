#include <BulletDynamics/Dynamics/btSimpleDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

class WorldType : public testing::Test, protected WorldParts<> {
 protected:
  // The sentence that a fluid refuses the world with; empty if it takes it.
  static std::string refusal(btDynamicsWorld&& world) {
    const btConstraintSolver* solver = world.getConstraintSolver();
    try {
      const Fluid fluid(world);
      EXPECT_NE(world.getConstraintSolver(), solver);
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(world.getConstraintSolver(), solver);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    EXPECT_EQ(world.getConstraintSolver(), solver);
    return {};
  }
  static void expectNames(const std::string& sentence, const char* refused, const char* advised) {
    EXPECT_NE(sentence.find(refused), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(advised), std::string::npos) << sentence;
  }
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
