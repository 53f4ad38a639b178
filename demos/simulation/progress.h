#pragma once

#include <chrono>
#include <string>

namespace ambient {

/// A line "label 42 %" on a terminal's standard error, shown from the second second on and wiped at
/// the end. Silent if standard error is not a terminal or `quiet`.
class Progress {
 public:
  Progress(std::string label, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @pre share in [0, 1]
  void update(double share);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool active_;
  Clock::time_point start_;
  Clock::time_point next_;
  bool shown_ = false;
};

}  // namespace ambient
