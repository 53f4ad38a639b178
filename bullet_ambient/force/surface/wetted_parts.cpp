#include "bullet_ambient/force/surface/wetted_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_ambient/force/kernels/part_sums.h"
#include "bullet_ambient/force/law/share_in_pool.h"

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

/// Returns the share of a part of the added mass that is between the sides of a pool: of a ball
/// with the second moment of a disc, whatever its tilt.
double partInPool(const PartBlock& block, int lane, const PoolSides& sides) {
  const auto at = [lane](const auto& rows, int row) { return rows[row][lane]; };
  const Vector3 centre(at(block.centre, 0), at(block.centre, 1), at(block.centre, 2));
  const double square = at(block.spread, 0) + at(block.spread, 1) + at(block.spread, 2);
  return shareInPool(sides, centre, Vector3::Zero(), 2 * square);
}

/// Calls visit(blocks) for all blocks at once, or, where the water ends at the sides of a pool, for
/// one after the other with the shares that are in the pool.
template <class Visit>
void forBlocksInPool(const PartBlocks& parts, const PoolSides* sides_F, const Visit& visit) {
  if (!sides_F) return visit(parts);
  for (std::size_t i = 0; i < parts.count; ++i) {
    PartBlock block = parts.blocks[i];
    for (int lane = 0; lane < PartBlock::kParts; ++lane) {
      const double share = partInPool(block, lane, *sides_F);
      for (auto& entry : block.inertia) entry[lane] *= share;
    }
    visit(PartBlocks{&block, 1});
  }
}

}  // namespace

WettedParts::WettedParts(const FluidBody& body, std::shared_ptr<const PackedParts> parts)
    : WettedInertia(body.added_mass),
      parts_(std::move(parts)),
      defect_(body.added_mass - parts_->sum()),
      volume_(body.volume) {}

Matrix6 WettedParts::inertiaAt(const Immersion& at) const noexcept {
  PartInertia sum{};
  forBlocksInPool(parts_->blocks(), at.plane.sides_F, [&](const PartBlocks& blocks) {
    const PartInertia more = fastestKernel().inertia(blocks, planeOf(at));
    for (int i = 0; i < PartBlock::kEntries; ++i) sum.entries[i] += more.entries[i];
  });
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
  InertiaGradient sum;
  forBlocksInPool(parts_->blocks(), at.plane.sides_F, [&](const PartBlocks& blocks) {
    const PartGradient g = fastestKernel().gradient(blocks, planeOf(at), products);
    sum.by_height += 0.5 * g.by_height;
    sum.by_normal += 0.5 * Vector3(g.by_normal[0], g.by_normal[1], g.by_normal[2]);
  });
  return sum;
}

}  // namespace ambient
