#pragma once

#include <pthread.h>

#include "bullet_ambient/base/task_runner.h"
#include "preprocess/base/parallel_for.h"

namespace ambient::test {

/// Spreads work over threads that each call starts anew; the calling thread works, too.
inline TaskRunner onThreads(int threads) {
  return [threads](int count, const std::function<void(int)>& run) {
    parallelFor(threads, count, [&run](std::ptrdiff_t i) { run(static_cast<int>(i)); });
  };
}

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
