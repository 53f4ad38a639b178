#include "preprocess/builder/elapsed_display.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "bullet_ambient/fluid_body/plain_text.h"

namespace ambient {

ElapsedDisplay::ElapsedDisplay(const std::string& label, bool quiet) : label_(plainLine(label)) {
  if (!quiet && ::isatty(STDERR_FILENO) != 0) thread_ = std::thread([this] { show(); });
}

ElapsedDisplay::~ElapsedDisplay() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void ElapsedDisplay::show() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (int seconds = 1;; ++seconds) {
    const auto is_over = [this] { return is_over_; };
    if (ended_.wait_for(lock, std::chrono::seconds(1), is_over)) {
      if (seconds > 1) std::fputs("\r\033[K", stderr);
      return;
    }
    const double percent = 100 * share_;
    if (percent > 0)
      std::fprintf(stderr, "\r\033[K%s, %.0f %%", label_.c_str(), percent);
    else
      std::fprintf(stderr, "\r\033[K%s, %d s", label_.c_str(), seconds);
    std::fflush(stderr);
  }
}

}  // namespace ambient
