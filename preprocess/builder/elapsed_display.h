#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace ambient {

/// A line "label, 3 s" on a terminal's standard error while it lives, from the second second on,
/// wiped at the end. Silent, and without a thread, if standard error is not a terminal.
class ElapsedDisplay {
 public:
  explicit ElapsedDisplay(std::string label);
  ~ElapsedDisplay();
  ElapsedDisplay(const ElapsedDisplay&) = delete;
  ElapsedDisplay& operator=(const ElapsedDisplay&) = delete;

 private:
  void show();

  std::string label_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace ambient
