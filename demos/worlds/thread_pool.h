#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "preprocess/base/parallel_for.h"

namespace ambient {

/// Threads that sleep between calls. Each begins with its own share of the items, always the same
/// one, and then takes from those of the others: items stay in the caches of one core.
class ThreadPool {
 public:
  /// Starts fewer threads if the system does not grant all. `threads` <= 0: one for each core. The
  /// calling thread works, too.
  explicit ThreadPool(int threads) : shares_(static_cast<std::size_t>(threadCount(threads))) {
    try {
      for (std::size_t i = 1; i < shares_.size(); ++i)
        helpers_.emplace_back([this, i] { wait(i); });
    } catch (const std::system_error&) {
      // The calling thread works on their shares.
    }
  }
  ~ThreadPool() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  std::size_t threads() const { return shares_.size(); }

  /// Calls body(i) once for every i in [0, count), in any order; `body` must not throw. Returns
  /// when all calls have returned.
  template <class Body>
  void run(std::size_t count, const Body& body) {
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      shares_[i].next = i * count / shares_.size();
      shares_[i].end = (i + 1) * count / shares_.size();
    }
    call_ = [](const void* what, std::size_t item) { (*static_cast<const Body*>(what))(item); };
    body_ = &body;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      working_ = helpers_.size();
      ++call_count_;
    }
    if (!helpers_.empty()) wake_.notify_all();
    work(0);
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait(lock, [this] { return working_ == 0; });
  }

 private:
  // On a line of the cache of its own.
  struct alignas(64) Share {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
  };

  void work(std::size_t own) {
    for (std::size_t k = 0; k < shares_.size(); ++k) {
      Share& share = shares_[(own + k) % shares_.size()];
      for (std::size_t i = share.next++; i < share.end; i = share.next++) call_(body_, i);
    }
  }

  void wait(std::size_t own) {
    for (std::size_t seen = 0;;) {
      {
        std::unique_lock<std::mutex> lock(mutex_);
        wake_.wait(lock, [&] { return is_ending_ || call_count_ != seen; });
        if (is_ending_) return;
        seen = call_count_;
      }
      work(own);
      const std::lock_guard<std::mutex> lock(mutex_);
      if (--working_ == 0) done_.notify_one();
    }
  }

  std::vector<Share> shares_;
  std::vector<std::thread> helpers_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::size_t call_count_ = 0, working_ = 0;  // guarded by mutex_
  bool is_ending_ = false;                    // likewise
  void (*call_)(const void*, std::size_t) = nullptr;
  const void* body_ = nullptr;
};

}  // namespace ambient
