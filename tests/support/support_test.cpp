#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <new>
#include <thread>
#include <vector>

#include "tests/support/allocation_counter.h"
#include "tests/support/thread_pool.h"

namespace ambient::test {
namespace {

// Counts the runs of each item.
class Counting final : public Task {
 public:
  explicit Counting(int count) : times_(static_cast<std::size_t>(count)) {}
  void run(int item) const noexcept override { ++times_[static_cast<std::size_t>(item)]; }
  bool allOnce() const {
    return std::all_of(times_.begin(), times_.end(), [](const auto& n) { return n == 1; });
  }

 private:
  mutable std::vector<std::atomic<int>> times_;
};

TEST(ThreadPool, RunsEveryItemOnce) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (const int count : {0, 1, 2, 7, 1000}) {
      const Counting counting(count);
      pool.runAll(counting, count);
      EXPECT_TRUE(counting.allOnce()) << threads << " threads, " << count << " items";
    }
  }
}

TEST(ThreadPool, UsesAllCoresByDefault) {
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  EXPECT_EQ(ThreadPool().threads(), std::max(1, cores));
}

TEST(ThreadPool, TheCallerDoesItAllWhereNoThreadCanBeStarted) {
  const test::NoMoreThreads none;
  ThreadPool pool(5);
  EXPECT_EQ(pool.threads(), 1);
  const Counting counting(100);
  pool.runAll(counting, 100);
  EXPECT_TRUE(counting.allOnce());
}

TEST(ThreadPool, SpreadsItemsThatWaitForEachOther) {
  // Finishes only if two threads run items simultaneously.
  class Meeting final : public Task {
   public:
    void run(int) const noexcept override {
      ++arrived;
      while (arrived < 2) std::this_thread::yield();
    }
    mutable std::atomic<int> arrived{0};
  };
  ThreadPool pool(2);
  const Meeting meeting;
  pool.runAll(meeting, 2);
  EXPECT_EQ(meeting.arrived, 2);
}

TEST(ThreadPool, ServesOneCallerAfterTheOther) {
  ThreadPool pool(3);
  for (int round = 0; round < 500; ++round) {
    const Counting counting(20);
    pool.runAll(counting, 20);
    ASSERT_TRUE(counting.allOnce()) << round;
  }
}

TEST(ThreadPool, ServesSeveralCallersAtATime) {
  ThreadPool pool(2);
  std::atomic<int> wrong{0};
  std::vector<std::thread> callers;
  for (int i = 0; i < 4; ++i) {
    callers.emplace_back([&] {
      for (int round = 0; round < 200; ++round) {
        const Counting counting(50);
        pool.runAll(counting, 50);
        wrong += !counting.allOnce();
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(wrong, 0);
}

void* volatile g_memory = nullptr;  // volatile: no allocation counts as unused

void* takeAligned() {
  void* memory = nullptr;
  return posix_memalign(&memory, 64, 128) == 0 ? memory : nullptr;
}

TEST(AllocationCounter, SeesOperatorNew) {
  const std::size_t count = allocationCount();
  g_memory = ::operator new(100);
  EXPECT_EQ(allocationCount(), count + 1);
  ::operator delete(g_memory);
}

TEST(AllocationCounter, SeesEveryFunctionOfTheCLibrary) {
  struct Way {
    const char* name;
    std::function<void*()> take;
  };
  const Way ways[] = {
      {"malloc", [] { return std::malloc(100); }},
      {"calloc", [] { return std::calloc(4, 25); }},
      {"realloc", [] { return std::realloc(nullptr, 100); }},
      {"aligned_alloc", [] { return std::aligned_alloc(64, 128); }},
      {"posix_memalign", takeAligned},
  };
  for (const Way& way : ways) {
    const std::size_t count = allocationCount(), bytes = allocatedBytes();
    g_memory = way.take();
    EXPECT_EQ(allocationCount(), count + 1) << way.name;
    EXPECT_GE(allocatedBytes(), bytes + 100) << way.name;
    std::free(g_memory);
  }
}

}  // namespace
}  // namespace ambient::test
