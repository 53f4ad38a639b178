#include "bullet_ambient/motion/motion_series_kernel.h"

namespace ambient {

SeriesEnd sumMotionSeriesBaseline(const SeriesStart& start) noexcept {
  return sumMotionSeries(start);
}

bool hasAvx2MotionSeries() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace ambient
