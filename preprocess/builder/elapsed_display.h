#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace ambient {

/// Shows progress on standard error while it exists: "label: stage, 3 s", or "label: stage, 42 %"
/// after update(). On a terminal: one line, first after one second, erased at the end; elsewhere a
/// line every `interval`. Silent if `quiet`, or if the system grants no thread.
class ElapsedDisplay {
 public:
  explicit ElapsedDisplay(const std::string& label, bool quiet = false,
                          std::chrono::milliseconds interval = std::chrono::seconds(10));
  ~ElapsedDisplay();
  ElapsedDisplay(const ElapsedDisplay&) = delete;
  ElapsedDisplay& operator=(const ElapsedDisplay&) = delete;

  /// Names the present stage; resets its share to 0.
  void begin(const std::string& stage);
  /// Sets the finished share of the stage, 0 to 1.
  void update(double share) { share_ = share; }

 private:
  using Clock = std::chrono::steady_clock;

  void show();
  std::string text() const;

  std::string label_;
  bool is_terminal_;
  std::chrono::milliseconds interval_;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;  // guards what follows
  std::condition_variable ended_;
  std::string stage_;
  bool is_over_ = false;
  std::atomic<double> share_{0};
  std::thread thread_;
};

}  // namespace ambient
