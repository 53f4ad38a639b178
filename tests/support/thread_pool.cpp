#include "tests/support/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace ambient::test {
namespace {

// Items are taken in portions: large for few accesses to the counter, small for an even share.
constexpr int kPortionsPerThread = 8;

}  // namespace

struct ThreadPool::Shared {
  std::mutex in_use;  // held by the caller whose task the threads work on

  std::mutex mutex;  // guards begun, ended, task, round, working and is_closing
  std::condition_variable begun, ended;
  const Task* task = nullptr;
  long long round = 0;  // number of tasks begun so far
  int working = 0;      // threads that have not ended this round
  bool is_closing = false;

  int count = 0, portion = 1;
  std::atomic<int> next{0};
  std::vector<std::thread> threads;

  void work() noexcept {
    for (int begin = next.fetch_add(portion); begin < count; begin = next.fetch_add(portion)) {
      for (int i = begin; i < std::min(begin + portion, count); ++i) task->run(i);
    }
  }

  void serve() noexcept {
    for (long long seen = 0;;) {
      {
        std::unique_lock<std::mutex> lock(mutex);
        begun.wait(lock, [&] { return is_closing || round != seen; });
        if (is_closing) return;
        seen = round;
      }
      work();
      const std::lock_guard<std::mutex> lock(mutex);
      if (--working == 0) ended.notify_one();
    }
  }

  void close() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      is_closing = true;
    }
    begun.notify_all();
    for (std::thread& thread : threads) thread.join();
  }
};

ThreadPool::ThreadPool(int threads) : shared_(std::make_unique<Shared>()) {
  const int wanted = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
  Shared& s = *shared_;
  try {
    for (int i = 1; i < wanted; ++i) s.threads.emplace_back([&s] { s.serve(); });
  } catch (const std::system_error&) {
    // The threads started so far and the caller do all items.
  } catch (...) {
    s.close();
    throw;
  }
}

ThreadPool::~ThreadPool() { shared_->close(); }

int ThreadPool::threads() const { return static_cast<int>(shared_->threads.size()) + 1; }

void ThreadPool::runAll(const Task& task, int count) noexcept {
  Shared& s = *shared_;
  const std::unique_lock<std::mutex> caller(s.in_use, std::try_to_lock);
  if (!caller || s.threads.empty() || count < 2) {
    for (int i = 0; i < count; ++i) task.run(i);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(s.mutex);
    s.task = &task;
    s.count = count;
    s.portion = std::max(1, count / (kPortionsPerThread * threads()));
    s.next = 0;
    s.working = static_cast<int>(s.threads.size());
    ++s.round;
  }
  s.begun.notify_all();
  s.work();
  std::unique_lock<std::mutex> lock(s.mutex);
  s.ended.wait(lock, [&] { return s.working == 0; });
}

}  // namespace ambient::test
