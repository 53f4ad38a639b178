// Energy of robots in an ideal fluid at rest: steps must not add energy and should rarely lose it.

#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/robot_dynamics.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/bullet_ambient/bullet/robots/state/robot_state_scene.h"
#include "tests/support/bits_of.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/run_program.h"

namespace ambient::test {
namespace {

struct EnergyRange {
  double lowest = 1, highest = 1, last = 1;  // over initial energy

  double deviation() const { return std::max(highest - 1, 1 - lowest); }
};

EnergyRange watch(RobotWorld& world, const btMultiBody& body, double hertz, double seconds) {
  const Fluid& fluid = world.fluid;
  const double start = kineticEnergy(fluid, body);
  EnergyRange range;
  for (int i = 0; i < std::lround(seconds * hertz); ++i) {
    world.step(1 / hertz);
    range.last = kineticEnergy(fluid, body) / start;
    if (!std::isfinite(range.last)) return {-1e300, 1e300, range.last};
    range.lowest = std::min(range.lowest, range.last);
    range.highest = std::max(range.highest, range.last);
  }
  return range;
}

// Adds a robot in an ideal fluid; added mass some five times its mass.
btMultiBody& addInFluid(RobotWorld& world, unsigned seed, const RobotDef& def) {
  Arbitrary arbitrary(seed);
  btMultiBody& body = world.add(arbitrary, def);
  putIntoFluid(arbitrary, world, body, 5);
  return body;
}

double deviationInFlight(Joints joints, double hertz) {
  RobotWorld world;
  RobotDef def;
  def.speed = 0.7;
  def.links = joints == Joints::kRevolute ? 3 : 5;
  def.joints = joints;
  const btMultiBody& body = addInFluid(world, 11, def);
  return watch(world, body, hertz, 10).deviation();
}

// Float: tolerance of rounding in 600 steps.
TEST(RobotFlight, KeepsItsEnergy) {
  EXPECT_LT(deviationInFlight(Joints::kRevolute, 60), kDouble ? 1e-11 : 1e-4);
  EXPECT_LT(deviationInFlight(Joints::kSmooth, 60), kDouble ? 1e-11 : 1e-4);
  EXPECT_LT(deviationInFlight(Joints::kAll, 60), kDouble ? 1e-11 : 1e-4);
}

// Adds weak motors to all joints, like PyBullet: rows in every step.
void addIdleMotors(RobotWorld& world, btMultiBody& body) {
  for (int i = 0; i < body.getNumLinks(); ++i)
    world.take(std::make_unique<btMultiBodyJointMotor>(&body, i, bt(0.1), bt(1e-12)));
}

RobotDef flyingRobot() {
  RobotDef def;
  def.speed = 0.7;
  def.collider_radius = 0.01;
  return def;
}

double deviationWithMotors(double hertz) {
  RobotWorld world;
  btMultiBody& body = addInFluid(world, 11, flyingRobot());
  addIdleMotors(world, body);
  return watch(world, body, hertz, 2).deviation();
}

TEST(RobotFlight, KeepsItsEnergyUnderIdleMotors) {
  EXPECT_LT(deviationWithMotors(60), kDouble ? 1e-10 : 1e-4);
}

// Momentum of robot and fluid about the origin of the world, rotation first.
Vector6 momentumOf(RobotWorld& world, const btMultiBody& body) {
  Coordinates u(body.getNumDofs() + 6);
  readVelocity(body, u);
  Vector6 momentum = (ambientMassMatrix(world.fluid, body) * u).head<6>();
  momentum.head<3>() += toVector3(body.getBasePos()).cross(momentum.tail<3>());
  return momentum;
}

// Motors reverse all joints at once, four times a second.
TEST(RobotFlight, KeepsItsMomentumUnderStrongMotors) {
  RobotWorld world;
  btMultiBody& body = addInFluid(world, 12, flyingRobot());
  std::vector<btMultiBodyJointMotor*> motors;
  for (int i = 0; i < body.getNumLinks(); ++i) {
    auto motor = std::make_unique<btMultiBodyJointMotor>(&body, i, bt(0), bt(1e6));
    motors.push_back(motor.get());
    world.take(std::move(motor));
  }
  const Vector6 start = momentumOf(world, body);
  for (int i = 0; i < 120; ++i) {
    const btScalar speed = bt(i / 15 % 2 == 0 ? 2 : -2);
    for (btMultiBodyJointMotor* motor : motors) motor->setVelocityTarget(speed);
    world.step(1.0 / 60);
    EXPECT_NEAR(body.getJointVel(0), speed, kDouble ? 1e-9 : 1e-4);
    const Vector6 momentum = momentumOf(world, body);
    EXPECT_LT((momentum - start).norm(), (kDouble ? 1e-11 : 1e-4) * start.norm()) << i;
  }
}

// Attaches thin plates: added mass ten thousand times their own across, none along.
void putPlatesIntoFluid(RobotWorld& world, btMultiBody& body) {
  for (int link = -1; link < body.getNumLinks(); ++link) {
    const double mass = static_cast<double>(link < 0 ? body.getBaseMass() : body.getLinkMass(link));
    Matrix6 added = Matrix6::Zero();
    added(5, 5) = 1e4 * mass;
    added(0, 0) = added(1, 1) = 1e4 * mass * 0.05 * 0.05;
    world.fluid.add(body, link,
                    {std::make_shared<FluidBody>(shapeWithoutFaces(added, 1e-9)), idealFluid(1)});
  }
}

TEST(RobotFlight, OfPlatesOfTenThousandTimesTheirMassInFluidKeepsItsEnergy) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    Arbitrary arbitrary(seed);
    RobotWorld world;
    RobotDef def;
    def.links = 5;
    def.speed = 0.5;
    btMultiBody& body = world.add(arbitrary, def);
    putPlatesIntoFluid(world, body);
    EXPECT_LT(watch(world, body, 60, 10).highest, kDouble ? 1 + 1e-9 : 1.001) << seed;
  }
}

TEST(RobotFlight, MotorsHoldPlatesOfTenThousandTimesTheirMassInFluid) {
  Arbitrary arbitrary(3);
  RobotWorld world;
  world.world.getSolverInfo().m_numIterations = 50;
  RobotDef def;
  def.links = 5;
  def.speed = 0;
  def.collider_radius = 0.01;
  btMultiBody& body = world.add(arbitrary, def);
  putPlatesIntoFluid(world, body);
  for (int i = 0; i < body.getNumLinks(); ++i)
    world.take(std::make_unique<btMultiBodyJointMotor>(&body, i, bt(0), bt(1e6)));
  std::vector<btScalar> angles;
  for (int i = 0; i < body.getNumLinks(); ++i) angles.push_back(body.getJointPos(i));
  for (int i = 0; i < 600; ++i) {
    body.addLinkForce(4, {0, 0, i % 120 < 60 ? bt(100) : bt(-100)});
    world.step(1.0 / 60);
  }
  for (int i = 0; i < body.getNumLinks(); ++i)
    EXPECT_NEAR(body.getJointPos(i), angles[i], 1e-3) << i;
  EXPECT_GT(velocityOf(body).head<6>().norm() + body.getBasePos().length(), 1e-3);
}

// Energy removed by the bound (31a): losses of turns after rows, less the reserve.
TEST(RobotFlight, OnATetherCountsTheEnergyThatItsBoundRemoves) {
  Arbitrary arbitrary(1);
  RobotWorld world;
  RobotDef def;
  def.speed = 10;
  def.collider_radius = 0.01;
  btMultiBody& body = world.add(arbitrary, def);
  putIntoFluid(arbitrary, world, body, 5);
  holdTip(world, body);
  const Fluid& fluid = world.fluid;
  const double start = kineticEnergy(fluid, body);
  world.step(1.0 / 60, 30);
  const double removed = fluid.find(body, -1)->counters().energy_removed;
  EXPECT_GT(removed, 0.01 * start);
  EXPECT_EQ(fluid.counters().energy_removed, removed);
}

// The bits of robots in a fluid do not hang on the processor's variants of the C library's sine,
// cosine and arc tangent; docs/conventions.md "The same bits". The C library chooses its variants
// when a program starts.

constexpr int kHashedSteps = 1200;  // 10 s

std::string bytesOf(const btScalar* numbers, int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) bytes += bitsOf(numbers[i]);
  return bytes;
}

// Position and velocity, what Bullet keeps of the joints, and the places of colliders.
std::string bytesOf(const btMultiBody& body) {
  std::string bytes = bytesOf(body.getBasePos(), 3) + bytesOf(body.getWorldToBaseRot(), 4) +
                      bytesOf(body.getVelocityVector(), body.getNumDofs() + 6);
  for (int i = 0; i < body.getNumLinks(); ++i) {
    const btMultibodyLink& link = body.getLink(i);
    bytes += bytesOf(link.m_jointPos, link.m_posVarCount) +
             bytesOf(link.m_cachedRotParentToThis, 4) + bytesOf(link.m_cachedRVector, 3);
    if (!link.m_collider) continue;
    const btTransform& place = link.m_collider->getWorldTransform();
    bytes += bytesOf(place.getOrigin(), 3);
    for (int row = 0; row < 3; ++row) bytes += bytesOf(place.getBasis()[row], 3);
  }
  return bytes;
}

// A program that sets joints turns their links by the C library.
void settleStart(btMultiBody& body) {
  for (int i = 0; i < body.getNumLinks(); ++i) settleLink(body.getLink(i));
  RobotWorld::moveColliders(body);
}

// One line for each robot in a fluid after each tenth of the steps.
void printHashes(RobotStateKind kind) {
  RobotStateScene scene(kind);
  for (int i = 0; i < scene.world().getNumMultibodies(); ++i) settleStart(scene.robot(i));
  for (int part = 0; part < 10; ++part) {
    scene.step(kHashedSteps / 10);
    for (int i = 0; i < scene.world().getNumMultibodies(); ++i) {
      const btMultiBody& body = scene.robot(i);
      if (!ambientBodiesOf(scene.fluid()).trees.find(&body)) continue;
      std::printf("hash of %d.%d.%d: %s\n", static_cast<int>(kind), i, part,
                  hashText(fnv1a64(bytesOf(body))).c_str());
    }
  }
}

// Prints hashes for another process. Tethers are left out: their anchors are where Bullet sees the
// tips.
TEST(RobotBits, DISABLED_Print) {
  for (const RobotStateKind kind : kRobotStateKinds)
    if (kind != RobotStateKind::kTethers) printHashes(kind);
}

std::string hashesWith(const char* tunables) {
  for (const char* name : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX", "GTEST_OUTPUT"})
    unsetenv(name);
  setenv("GLIBC_TUNABLES", tunables, 1);
  const ProgramResult result =
      runProgram("/proc/self/exe",
                 {"--gtest_filter=RobotBits.DISABLED_Print", "--gtest_also_run_disabled_tests"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::string hashes;
  for (std::size_t at = result.output.find("hash of"); at != std::string::npos;
       at = result.output.find("hash of", at + 1))
    hashes += result.output.substr(at, result.output.find('\n', at) - at + 1);
  return hashes;
}

TEST(RobotBits, DoNotHangOnTheProcessor) {
  const std::string native = hashesWith("");
  EXPECT_GT(native.size(), 2000u);
  EXPECT_EQ(native, hashesWith("glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F"));
}

}  // namespace
}  // namespace ambient::test
