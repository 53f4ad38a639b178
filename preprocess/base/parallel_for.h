#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace ambient {

/// Number of threads for a setting: the setting itself, or the number of cores if it is <= 0.
inline int threadCount(int setting) {
  return setting > 0 ? setting : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Calls body(i) once for every i in [0, count), on up to `threads` threads, in any order. Returns
/// when all calls have returned. Uses fewer threads if the system does not grant all. Rethrows the
/// first exception; the calls not yet begun are then left out. Results do not depend on the
/// number of threads as long as body(i) writes only what belongs to i.
template <typename Body>
void parallelFor(int threads, std::ptrdiff_t count, const Body& body) {
  std::atomic<std::ptrdiff_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (std::ptrdiff_t i = next++; i < count; i = next++) body(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> helpers;
  const std::ptrdiff_t extra = std::min<std::ptrdiff_t>(threads, count) - 1;
  try {
    for (std::ptrdiff_t k = 0; k < extra; ++k) helpers.emplace_back(work);
  } catch (const std::system_error&) {
    // The threads started so far and the calling thread do all the work.
  }
  work();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace ambient
