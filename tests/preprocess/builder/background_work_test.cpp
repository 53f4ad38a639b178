#include "preprocess/builder/background_work.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/no_more_threads.h"

namespace ambient {
namespace {

TEST(BackgroundWork, DoesTasksInTheirOrder) {
  std::vector<int> done;
  BackgroundWork work;
  for (int i = 0; i < 5; ++i) work.add([&done, i] { done.push_back(i); });
  work.finish();
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(BackgroundWork, DoesATaskAtOnceWhereNoThreadCanBeStarted) {
  const test::NoMoreThreads none;
  int done = 0;
  BackgroundWork work;
  work.add([&done] { ++done; });
  EXPECT_EQ(done, 1);
  work.finish();
}

}  // namespace
}  // namespace ambient
