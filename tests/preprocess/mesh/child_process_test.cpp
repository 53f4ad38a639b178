#include "preprocess/mesh/child_process.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

std::string failure(const std::function<std::string()>& work) {
  return messageOf([&] { runInChild(work, 1); });
}

TEST(ChildProcess, ReturnsWhatItsWorkReturns) {
  EXPECT_EQ(runInChild([] { return std::string(); }, 10), "");
  std::string bytes(3'000'000, 'x');  // more than a pipe holds
  bytes[1'000'000] = '\0';
  EXPECT_EQ(runInChild([&] { return bytes; }, 10), bytes);
}

TEST(ChildProcess, LeavesTheParentAsItWas) {
  int number = 1;
  runInChild(
      [&] {
        number = 2;
        return std::string();
      },
      10);
  EXPECT_EQ(number, 1);
}

TEST(ChildProcess, PassesOnWhatIsThrown) {
  EXPECT_EQ(failure([]() -> std::string { throw std::runtime_error("file: bad"); }), "file: bad");
}

TEST(ChildProcess, SurvivesCrashesAndEndlessLoops) {
  EXPECT_EQ(failure([]() -> std::string {
              std::raise(SIGSEGV);
              return {};
            }),
            "crashed");
  EXPECT_EQ(failure([]() -> std::string { std::abort(); }), "crashed");
  EXPECT_EQ(failure([]() -> std::string {
              std::raise(SIGKILL);
              return {};
            }),
            "was killed, perhaps for want of memory");
  EXPECT_EQ(failure([]() -> std::string {
              for (volatile unsigned i = 0;; i = i + 1) {
              }
            }),
            "took more than 1 s of processor time");
}

}  // namespace
}  // namespace ambient
