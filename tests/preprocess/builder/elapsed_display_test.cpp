#include "preprocess/builder/elapsed_display.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/support/no_more_threads.h"

namespace ambient {
namespace {

/// Captures the display's output on standard error, which is then not a terminal.
std::string shown(const std::function<void(ElapsedDisplay&)>& work, bool quiet = false) {
  ::testing::internal::CaptureStderr();
  {
    ElapsedDisplay display("building hull", quiet, std::chrono::milliseconds(20));
    work(display);
  }
  return ::testing::internal::GetCapturedStderr();
}

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(300)); }

TEST(ElapsedDisplay, WritesLinesWhereThereIsNoTerminal) {
  const std::string text = shown([](ElapsedDisplay& display) {
    display.begin("solving the flow");
    rest();
    display.update(0.42);
    rest();
  });
  EXPECT_NE(text.find("building hull: solving the flow, 0 s\n"), std::string::npos) << text;
  EXPECT_NE(text.find("building hull: solving the flow, 42 %\n"), std::string::npos) << text;
  EXPECT_EQ(text.find('\r'), std::string::npos) << text;
}

TEST(ElapsedDisplay, IsSilentIfItIsToldToOrHasNoThread) {
  EXPECT_EQ(shown([](ElapsedDisplay&) { rest(); }, true), "");
  const test::NoMoreThreads none;
  EXPECT_EQ(shown([](ElapsedDisplay&) { rest(); }), "");
}

}  // namespace
}  // namespace ambient
