#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace ambient {

/// A line "label, 3 s" on a terminal's standard error while it lives, from the second second on,
/// wiped at the end; "label, 42 %" once it is told the share. Silent, and without a thread, if
/// standard error is not a terminal or `quiet`.
class ElapsedDisplay {
 public:
  explicit ElapsedDisplay(const std::string& label, bool quiet = false);
  ~ElapsedDisplay();
  ElapsedDisplay(const ElapsedDisplay&) = delete;
  ElapsedDisplay& operator=(const ElapsedDisplay&) = delete;

  /// How much is done, from 0 to 1.
  void update(double share) { share_ = share; }

 private:
  void show();

  std::string label_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_over_ = false;
  std::atomic<double> share_{0};
  std::thread thread_;
};

}  // namespace ambient
