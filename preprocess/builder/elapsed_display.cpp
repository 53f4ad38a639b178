#include "preprocess/builder/elapsed_display.h"

#include <unistd.h>

#include <cstdio>
#include <system_error>
#include <utility>

#include "bullet_ambient/base/plain_text.h"

namespace ambient {

ElapsedDisplay::ElapsedDisplay(const std::string& label, bool quiet,
                               std::chrono::milliseconds interval)
    : label_(plainLine(label)),
      is_terminal_(::isatty(STDERR_FILENO) != 0),
      interval_(is_terminal_ ? std::chrono::seconds(1) : interval) {
  if (!quiet) start();
}

ElapsedDisplay::ElapsedDisplay(const std::string& label, Print print,
                               std::chrono::milliseconds interval)
    : label_(plainLine(label)), print_(std::move(print)), is_terminal_(false), interval_(interval) {
  start();
}

void ElapsedDisplay::start() {
  try {
    thread_ = std::thread([this] { show(); });
  } catch (const std::system_error&) {
    // The work matters more.
  }
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

void ElapsedDisplay::begin(const std::string& stage) {
  const std::lock_guard<std::mutex> lock(mutex_);
  stage_ = plainLine(stage);
  share_ = 0;
}

std::string ElapsedDisplay::text() const {
  const double percent = 100 * share_;
  const std::chrono::duration<double> seconds = Clock::now() - start_;
  char amount[32];
  std::snprintf(amount, sizeof amount, percent > 0 ? ", %.0f %%" : ", %.0f s",
                percent > 0 ? percent : seconds.count());
  return label_ + (stage_.empty() ? "" : ": ") + stage_ + amount;
}

void ElapsedDisplay::show() {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto is_over = [this] { return is_over_; };
  for (bool is_shown = false;; is_shown = true) {
    if (ended_.wait_for(lock, interval_, is_over)) {
      if (is_terminal_ && is_shown) std::fputs("\r\033[K", stderr);
      return;
    }
    if (print_) {
      print_(text());
      continue;
    }
    std::fprintf(stderr, is_terminal_ ? "\r\033[K%s" : "%s\n", text().c_str());
    std::fflush(stderr);
  }
}

}  // namespace ambient
