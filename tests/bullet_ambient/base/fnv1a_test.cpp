#include "bullet_ambient/base/fnv1a.h"

#include <gtest/gtest.h>

namespace ambient {
namespace {

// Test vectors of Noll's reference page and draft-eastlake-fnv.
TEST(Fnv1a, HasTheValuesOfItsTestVectors) {
  EXPECT_EQ(fnv1a64(""), 0xcbf29ce484222325u);
  EXPECT_EQ(fnv1a64("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(fnv1a64("foobar"), 0x85944171f73967e8u);
}

TEST(Fnv1a, CountsBytesAboveSevenBitsAsUnsigned) {
  EXPECT_EQ(fnv1a64("\xff"), (0xcbf29ce484222325u ^ 0xffu) * 0x100000001b3u);
}

TEST(Fnv1a, IsKnownAtCompileTime) { static_assert(fnv1a64("a") == 0xaf63dc4c8601ec8cu); }

}  // namespace
}  // namespace ambient
