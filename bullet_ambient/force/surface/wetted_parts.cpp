#include "bullet_ambient/force/surface/wetted_parts.h"

#include <algorithm>
#include <utility>

#include "bullet_ambient/force/kernels/part_sums.h"

namespace ambient {
namespace {

const PartKernel& fastestKernel() noexcept {
  static const PartKernel& fastest = *kPartKernels.fastest();
  return fastest;
}

/// Plane with the reach kappa H of the weights; kappa fades to 0 at a deep body, eq. (61).
PartPlane planeOf(const Immersion& at) {
  constexpr double kReach = 0.06;
  const double x = std::clamp(at.cover() / at.size(), 0.0, 2.0);
  const double fade = (9 / (1 + x * x * x) - 1) / 8;
  const Vector3& s = at.plane.normal;
  return {{s.x(), s.y(), s.z()}, at.plane.height, kReach * fade * at.size()};
}

}  // namespace

WettedParts::WettedParts(const FluidBody& body, std::shared_ptr<const PackedParts> parts)
    : WettedInertia(body.added_mass),
      parts_(std::move(parts)),
      defect_(body.added_mass - parts_->sum()),
      volume_(body.volume) {}

Matrix6 WettedParts::inertiaAt(const Immersion& at) const noexcept {
  const PartInertia sum = fastestKernel().inertia(parts_->blocks(), planeOf(at));
  Matrix6 K = wetShare(at, volume_) * defect_;
  int entry = 0;
  for (int row = 0; row < 6; ++row) {
    K(row, row) += sum.entries[entry++];
    for (int column = row + 1; column < 6; ++column, ++entry) {
      K(row, column) += sum.entries[entry];
      K(column, row) = K(row, column);
    }
  }
  return K;
}

InertiaGradient WettedParts::gradientAt(const Immersion& at, const Twist& twist) const noexcept {
  const Vector6 x = twist.vector();
  double products[PartBlock::kEntries];
  int entry = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      products[entry++] = (row == column ? 1 : 2) * x[row] * x[column];
  const PartGradient g = fastestKernel().gradient(parts_->blocks(), planeOf(at), products);
  return {0.5 * g.by_height, {0.5 * g.by_normal[0], 0.5 * g.by_normal[1], 0.5 * g.by_normal[2]}};
}

}  // namespace ambient
