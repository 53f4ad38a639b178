#include "bullet_ambient/force/law/share_in_pool.h"

#include <cmath>

#include "bullet_ambient/force/law/wet_share.h"

namespace ambient {

double shareInPool(const PoolSides& sides, const Vector3& centroid, const Vector3& normal,
                   double radius_sq) noexcept {
  double share = 1;
  for (int i = 0; i < sides.count; ++i) {
    const PoolSides::Side& side = sides.of[i];
    share *= wetShareOf(side.normal.dot(side.point - centroid), side.normal.dot(normal), radius_sq,
                        [](double x) { return std::sqrt(x); });
  }
  return share;
}

}  // namespace ambient
