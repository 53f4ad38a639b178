// The bits of robots in a fluid do not hang on the processor's variants of the C library's sine,
// cosine and arc tangent; docs/conventions.md "The same bits". The C library chooses its variants
// when a program starts.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "tests/bullet_ambient/bullet/robots/state/robot_state_scene.h"
#include "tests/support/bits_of.h"
#include "tests/support/run_program.h"

namespace ambient::test {
namespace {

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
      if (!membersOf(scene.fluid()).trees.find(&body)) continue;
      std::printf("hash of %d.%d.%d: %s\n", static_cast<int>(kind), i, part,
                  hashText(fnv1a64(bytesOf(body))).c_str());
    }
  }
}

// What another process prints. Tethers are left out: their anchors are where Bullet sees the tips.
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
