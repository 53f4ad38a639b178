#include "bullet_ambient/base/ambient_assert.h"

#include <gtest/gtest.h>

namespace ambient {
namespace {

#if defined(NDEBUG)
TEST(AmbientAssert, EvaluatesNothingInRelease) {
  int calls = 0;
  AMBIENT_ASSERT(++calls < 0);
  EXPECT_EQ(calls, 0);
}
#else
TEST(AmbientAssertDeathTest, NamesWhatDidNotHoldAndWhere) {
  const int lanes = 9;
  AMBIENT_ASSERT(lanes > 8);
  EXPECT_DEATH(AMBIENT_ASSERT(lanes <= 8),
               "ambient_assert_test.cpp:[0-9]+: this must hold: lanes <= 8");
}
#endif

}  // namespace
}  // namespace ambient
