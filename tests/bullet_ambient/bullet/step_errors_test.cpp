#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

/// Number of steps of equal error, `most` at most, before add() reports a large sum.
int stepsBeforeLarge(double error, int most) {
  StepErrors errors;
  for (int i = 0; i < most; ++i)
    if (errors.add(error)) return i;
  return most;
}

TEST(StepErrors, OneLargeStepIsTooMuch) {
  EXPECT_EQ(stepsBeforeLarge(1.01 * StepErrors::kLargest, 10), 0);
  EXPECT_EQ(stepsBeforeLarge(0.99 * StepErrors::kLargest, 10), 1);
}

// Sum of equal errors tends to sqrt(64) times one error.
TEST(StepErrors, SmallOnesAddUpToEightTimesOne) {
  EXPECT_LT(stepsBeforeLarge(1.01 / 8 * StepErrors::kLargest, 10000), 500);
  EXPECT_EQ(stepsBeforeLarge(0.99 / 8 * StepErrors::kLargest, 10000), 10000);
}

TEST(StepErrors, AreForgotten) {
  StepErrors errors;
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(errors.add(0.8 * StepErrors::kLargest)) << i;
    for (int calm = 0; calm < 256; ++calm) errors.add(0);
  }
}

TEST(StepErrors, AreToldOnce) {
  StepErrors errors;
  EXPECT_TRUE(errors.add(1));
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(errors.add(i % 2));
}

TEST(StepErrors, AreReportedOfOneBodyAndCountedOfAll) {
  FluidWorld scene;
  const Vector3 semi_axes(0.05, 0.05, 0.01);
  BodyDef def{2e-4, ellipsoidMoments(semi_axes, 2e-4),
              startWith({Vector3(100, 50, 20), Vector3(300, 0, 200)})};
  FluidBody shape = meshedEllipsoid(semi_axes, 2);
  for (const char* name : {"feather", "flake"}) {
    shape.name = name;
    scene.add(def, shape, air());
  }
  scene.step(1.0 / 60, 60);
  ASSERT_EQ(scene.said.size(), 1u);
  const bool names_one = scene.said[0].find("'feather'") != std::string::npos ||
                         scene.said[0].find("'flake'") != std::string::npos;
  EXPECT_TRUE(names_one) << scene.said[0];
  EXPECT_NE(scene.said[0].find("take shorter steps"), std::string::npos) << scene.said[0];
  EXPECT_EQ(scene.fluid.counters().too_long, 2);
}

// Numbers that are not finite must not spread to other bodies.

const auto kNan = std::numeric_limits<btScalar>::quiet_NaN();
using Spoil = std::function<void(btRigidBody&)>;

// Two bodies in air, 50 m apart or touching; `sick` gets a broken number after some steps.
struct Pair {
  FluidWorld scene;
  btSphereShape ball{static_cast<btScalar>(0.3)};
  btRigidBody* healthy = nullptr;
  btRigidBody* sick = nullptr;

  explicit Pair(double distance) {
    const FluidBody shape = meshedEllipsoid(kUnequalAxes, 1);
    BodyDef def;
    def.shape = &ball;
    healthy = &scene.add(def, shape, air());
    def.start.position = {distance, 0, 0};
    def.start.twist = {Vector3(1, 2, 3), Vector3(-1, 0, 0)};
    sick = &scene.add(def, shape, air());
  }
};

const Spoil kSpoils[] = {
    [](btRigidBody& b) {
      b.setLinearVelocity({kNan, 0, 0});
    },
    [](btRigidBody& b) {
      b.setAngularVelocity({0, kNan, 0});
    },
    [](btRigidBody& b) {
      b.applyCentralForce({0, 0, kNan});
    },
    [](btRigidBody& b) {
      b.applyTorque({kNan, 0, 0});
    },
};

TEST(BrokenNumbers, InVelocityForceAndTorqueStayWithTheirBody) {
  for (const double distance : {50.0, 0.59}) {
    for (const Spoil& spoil : kSpoils) {
      Pair pair(distance);
      pair.scene.step(1.0 / 60, 2);
      spoil(*pair.sick);
      pair.scene.step(1.0 / 60, 30);
      EXPECT_TRUE(readState(*pair.healthy).isFinite()) << distance;
      EXPECT_EQ(pair.scene.of(*pair.healthy).counters().rejected, 0) << distance;
      EXPECT_GT(pair.scene.of(*pair.sick).counters().rejected, 0) << distance;
      ASSERT_EQ(pair.scene.said.size(), 1u) << distance;
      EXPECT_NE(pair.scene.said[0].find("not finite"), std::string::npos);
    }
  }
}

TEST(BrokenNumbers, InTheForceOfOneStepAreForgottenInTheNext) {
  Pair pair(50);
  pair.sick->applyCentralForce({0, 0, kNan});
  pair.scene.step(1.0 / 60);
  const btVector3 before = pair.sick->getWorldTransform().getOrigin();
  pair.scene.step(1.0 / 60, 60);
  EXPECT_TRUE(readState(*pair.sick).isFinite());
  EXPECT_GT(static_cast<double>((pair.sick->getWorldTransform().getOrigin() - before).length()),
            0.5);
}

// A box at rest on a plane under forces with overflowing squares, or overflowing velocities.
TEST(BrokenNumbers, OfRowsAreDroppedAndReported) {
  const double largest = static_cast<double>(std::numeric_limits<btScalar>::max());
  for (const double force : {1e25, std::sqrt(largest), largest / 100, largest}) {
    // Rows are in double: squares of all floats are finite in double.
    const bool is_too_large = kDouble && force >= std::sqrt(largest);
    FluidWorld scene;
    std::string said;
    scene.fluid.setReport([&](const std::string& text) { said += text; });
    btStaticPlaneShape plane({0, 0, 1}, 0);
    btRigidBody floor(0, nullptr, &plane);
    scene.world.addRigidBody(&floor);
    btBoxShape box({bt(0.5), bt(0.5), bt(0.5)});
    btRigidBody& body = scene.add({1, Vector3::Ones(), startAt({0, 0, 0.5}), &box},
                                  meshedEllipsoid(kUnequalAxes, 1), water());
    body.applyCentralForce({0, 0, bt(-force)});
    for (int i = 0; i < 10; ++i) {
      scene.step(1.0 / 60);
      EXPECT_TRUE(readState(body).isFinite()) << force << " N, step " << i;
      scene.world.clearForces();
    }
    const bool is_reported = said.find("not finite") != std::string::npos;
    const bool is_rejected = scene.of(body).counters().rejected > 0;
    EXPECT_EQ(is_rejected, is_too_large) << force;
    EXPECT_EQ(is_reported, is_too_large) << force;
    scene.world.removeRigidBody(&floor);
  }
}

}  // namespace
}  // namespace ambient::test
