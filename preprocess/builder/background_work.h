#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <queue>
#include <thread>

namespace ambient {

/// One background thread that does tasks in order. The thread starts with the first task. The
/// destructor waits for the present task and drops the others.
class BackgroundWork {
 public:
  BackgroundWork() = default;
  ~BackgroundWork();
  BackgroundWork(const BackgroundWork&) = delete;
  BackgroundWork& operator=(const BackgroundWork&) = delete;

  /// Adds a task. Where the system gives no thread, does it before it returns.
  /// @pre the task does not throw.
  void add(std::function<void()> task);
  /// Waits until all tasks are done.
  void finish();

 private:
  /// Starts the thread if there is none; false if the system grants none.
  bool hasThread();
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::queue<std::function<void()>> tasks_;  // the one in work is first
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace ambient
