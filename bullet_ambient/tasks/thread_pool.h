#pragma once

#include <memory>

#include "bullet_ambient/tasks/task_runner.h"

namespace ambient {

/// Threads of its own that sleep between calls. The calling thread works, too; if the threads are
/// busy for another caller, it works alone.
class ThreadPool : public TaskRunner {
 public:
  /// @param threads that work together, the caller's included; 0 or less: all cores. Where the
  /// system gives fewer, fewer work: threads() tells.
  explicit ThreadPool(int threads = 0);
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const;
  void runAll(const Task& task, int count) noexcept override;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace ambient
