#include "bullet_ambient/motion/motion_series_kernel.h"

namespace ambient {

SeriesEnd sumMotionSeriesAvx2(const SeriesStart& start) noexcept { return sumMotionSeries(start); }

}  // namespace ambient
