#include "demos/simulation/progress.h"

#include <unistd.h>

#include <cstdio>

#include "bullet_ambient/spatial/ambient_assert.h"

namespace ambient {
namespace {

constexpr std::chrono::milliseconds kFirst{1000};
constexpr std::chrono::milliseconds kInterval{100};

}  // namespace

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)),
      active_(!quiet && ::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      next_(start_ + kFirst) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::update(double share) {
  AMBIENT_ASSERT(share >= 0 && share <= 1);
  if (!active_ || Clock::now() < next_) return;
  next_ = Clock::now() + kInterval;
  shown_ = true;
  std::fprintf(stderr, "\r\033[K%s %3.0f %%", label_.c_str(), 100 * share);
  std::fflush(stderr);
}

}  // namespace ambient
