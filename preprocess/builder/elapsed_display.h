#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace ambient {

/// Shows progress on standard error while it exists: "label: stage, 3 s", or "label: stage, 42 %"
/// after update(). On a terminal: one line, first after one second, erased at the end; elsewhere a
/// line every `interval`. Silent if `quiet`, or if the system grants no thread.
class ElapsedDisplay {
 public:
  using Print = std::function<void(const std::string& line)>;

  explicit ElapsedDisplay(const std::string& label, bool quiet = false,
                          std::chrono::milliseconds interval = std::chrono::seconds(10));
  /// Gives a line to `print` every `interval`, on a thread of its own.
  ElapsedDisplay(const std::string& label, Print print, std::chrono::milliseconds interval);
  ~ElapsedDisplay();
  ElapsedDisplay(const ElapsedDisplay&) = delete;
  ElapsedDisplay& operator=(const ElapsedDisplay&) = delete;

  /// Names the present stage; resets its share to 0.
  void begin(const std::string& stage);
  /// Sets the finished share of the stage, 0 to 1.
  void update(double share) { share_ = share; }

 private:
  using Clock = std::chrono::steady_clock;

  void start();
  void show();
  std::string text() const;

  std::string label_;
  Print print_;  // null: standard error
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
