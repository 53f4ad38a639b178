#pragma once

#include <pthread.h>

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

/// Scope in which no thread can start: the default stack is larger than the address space.
class NoMoreThreads {
 public:
  NoMoreThreads() {
    constexpr std::size_t kStack = std::size_t{1} << 47;  // [bytes]
    pthread_attr_t attributes;
    pthread_getattr_default_np(&attributes);
    pthread_attr_getstacksize(&attributes, &stack_before_);
    setDefaultStack(kStack);
    pthread_attr_destroy(&attributes);
  }
  ~NoMoreThreads() { setDefaultStack(stack_before_); }
  NoMoreThreads(const NoMoreThreads&) = delete;
  NoMoreThreads& operator=(const NoMoreThreads&) = delete;

 private:
  static void setDefaultStack(std::size_t bytes) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, bytes);
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
  }

  std::size_t stack_before_ = 0;
};

}  // namespace ambient::test
