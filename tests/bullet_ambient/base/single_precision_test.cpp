#include "bullet_ambient/base/single_precision.h"

#include <gtest/gtest.h>

namespace ambient {
namespace {

TEST(SinglePrecision, IsWhatFilesHold) {
  EXPECT_EQ(roundedToSingle(0.1), 13421773.0 / 134217728);  // 24 bits
  EXPECT_EQ(roundedToSingle(1 + 0x1p-24), 1);
  EXPECT_EQ(roundedToSingle(-0.5), -0.5);
}

}  // namespace
}  // namespace ambient
