#include <gtest/gtest.h>

#include "tests/bullet_ambient/bullet/robots/state/robot_state_scene.h"
#include "tests/support/allocation_counter.h"

namespace ambient::test {
namespace {

// First steps size every buffer. Scenes: flight, motors and limits, contacts, joints to the world,
// the surface of water in waves.
TEST(RobotStep, AllocatesNothing) {
  for (const RobotStateKind kind : kRobotStateKinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    RobotStateScene scene(kind);
    // Bullet allocates memory in each step to sort pairs.
    scene.world().getDispatchInfo().m_deterministicOverlappingPairs = false;
    scene.step(360);
    const std::size_t before = allocationCount();
    scene.step(120);
    EXPECT_EQ(allocationCount(), before);
  }
}

}  // namespace
}  // namespace ambient::test
