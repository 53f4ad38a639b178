#pragma once

#include <memory>

#include "bullet_ambient/base/task_runner.h"

namespace ambient::test {

/// Owns threads that sleep between calls. The calling thread works, too. While the pool's threads
/// are busy for another caller, the calling thread does all items alone.
class ThreadPool : public TaskRunner {
 public:
  /// @param threads number of threads that work, including the caller's; 0 or less: all cores. The
  /// system may grant fewer; threads() returns the number granted.
  explicit ThreadPool(int threads = 0);
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const;  ///< threads that work, including the caller's
  void runAll(const Task& task, int count) noexcept override;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace ambient::test
