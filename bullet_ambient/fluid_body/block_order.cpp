#include "bullet_ambient/fluid_body/block_order.h"

#include <algorithm>
#include <numeric>

namespace ambient {
namespace {

using Order = std::vector<std::uint32_t>;

struct BlockOrder {
  const std::vector<Vector6>& coordinates;
  std::ptrdiff_t block_size;

  void sort(Order::iterator begin, Order::iterator end) const {
    const std::ptrdiff_t blocks = (end - begin + block_size - 1) / block_size;
    if (blocks <= 1) return std::sort(begin, end);
    const auto middle = begin + (blocks + 1) / 2 * block_size;
    const Eigen::Index axis = widestAxis(begin, end);
    std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
      const double x = coordinates[a][axis], y = coordinates[b][axis];
      return x < y || (x == y && a < b);
    });
    sort(begin, middle);
    sort(middle, end);
  }

  Eigen::Index widestAxis(Order::iterator begin, Order::iterator end) const {
    Vector6 low = coordinates[*begin], high = low;
    for (auto at = begin; at != end; ++at) {
      low = low.cwiseMin(coordinates[*at]);
      high = high.cwiseMax(coordinates[*at]);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    return axis;
  }
};

}  // namespace

std::vector<std::uint32_t> orderInBlocks(const std::vector<Vector6>& coordinates,
                                         std::size_t block_size) {
  Order order(coordinates.size());
  std::iota(order.begin(), order.end(), 0u);
  BlockOrder{coordinates, static_cast<std::ptrdiff_t>(block_size)}.sort(order.begin(), order.end());
  return order;
}

}  // namespace ambient
