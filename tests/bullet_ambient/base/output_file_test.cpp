#include "preprocess/base/output_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/support/text_files.h"

namespace ambient {
namespace {

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

}  // namespace
}  // namespace ambient
