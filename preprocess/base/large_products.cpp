#include "preprocess/base/large_products.h"

#include <Eigen/Core>

namespace ambient {

void fixBlocksOfLargeProducts() {
  // Eigen's sizes are written only once: other threads may be multiplying in later calls.
  [[maybe_unused]] static const bool is_done = [] {
    Eigen::setCpuCacheSizes(32 << 10, 1 << 20, 8 << 20);
    return true;
  }();
}

}  // namespace ambient
