#include <gtest/gtest.h>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/single_precision.h"
#include "preprocess/base/output_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_files.h"

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
  EXPECT_DEATH(AMBIENT_ASSERT(lanes <= 8), "base_test.cpp:[0-9]+: this must hold: lanes <= 8");
}
#endif

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

TEST(OutputFile, HasItsNameOnlyAfterCommit) {
  const TemporaryFolder folder;
  const auto file = folder / "a.txt";
  {
    OutputFile output(file);
    output.write("text");
    EXPECT_FALSE(std::filesystem::exists(file));
    output.commit();
  }
  EXPECT_EQ(readText(file), "text");
}

TEST(OutputFile, LeavesNothingWithoutCommitAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  const auto file = folder / "a.txt";
  std::ofstream(file) << "old";
  { OutputFile(file).write("new"); }
  EXPECT_EQ(readText(file), "old");
  std::filesystem::remove(file);
  EXPECT_TRUE(folder.empty());
}

TEST(OutputFile, NamesAFileThatCannotBeWritten) {
  EXPECT_THROW(OutputFile("no/such/folder/a.txt"), std::runtime_error);
}

TEST(SinglePrecision, IsWhatFilesHold) {
  EXPECT_EQ(roundedToSingle(0.1), 13421773.0 / 134217728);  // 24 bits
  EXPECT_EQ(roundedToSingle(1 + 0x1p-24), 1);
  EXPECT_EQ(roundedToSingle(-0.5), -0.5);
}

}  // namespace
}  // namespace ambient
