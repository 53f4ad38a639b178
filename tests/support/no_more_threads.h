#pragma once

#include <pthread.h>

namespace ambient::test {

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
