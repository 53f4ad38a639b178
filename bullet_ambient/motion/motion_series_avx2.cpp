#include "bullet_ambient/motion/motion_series_kernel.h"

namespace ambient {

SeriesEnd sumMotionSeriesAvx2(const SeriesStart& start) noexcept {
  return MotionSeries(start).end();
}

}  // namespace ambient
