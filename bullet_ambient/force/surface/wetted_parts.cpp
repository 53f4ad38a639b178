#include "bullet_ambient/force/surface/wetted_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/kernels/part_sums.h"
#include "bullet_ambient/force/law/share_in_pool.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

namespace {

/// Plane with the reach kappa H of the weights; kappa fades to 0 at a deep body, eq. (61).
PartPlane planeOf(const Immersion& at) {
  constexpr double kReach = 0.06;
  const double x = std::clamp(at.submergence() / at.size(), 0.0, 2.0);
  const double fade = (9 / (1 + x * x * x) - 1) / 8;
  const Vector3& s = at.plane.normal;
  return {{s.x(), s.y(), s.z()}, at.plane.height, kReach * fade * at.size()};
}

/// Returns the share of the image of a part of the added mass, with axes turned, that is between
/// the sides of a pool: of a ball with the second moment of a disc, whatever its tilt.
double partInPool(const PartBlock& block, int lane, int turned, const PoolSides& sides) {
  const auto at = [lane](const auto& rows, int row) {
    return static_cast<double>(rows[row][lane]);
  };
  Vector3 centre(at(block.centre, 0), at(block.centre, 1), at(block.centre, 2));
  for (int axis = 0; axis < 3; ++axis)
    if (turned >> axis & 1) centre[axis] = -centre[axis];
  const double square = at(block.spread, 0) + at(block.spread, 1) + at(block.spread, 2);
  return shareInPool(sides, centre, Vector3::Zero(), 2 * square);
}

/// Calls visit(blocks) for all blocks at once, or, where the water ends at the sides of a pool, for
/// one after the other with the shares that are in the pool.
template <class Visit>
void forBlocksInPool(const PartBlocks& parts, const PoolSides* sides_F, const Visit& visit) {
  if (!sides_F) return visit(parts);
  for (std::size_t i = 0; i < parts.count; ++i) {
    constexpr int kParts = PartBlock::kParts, kMostImages = 8;
    double shares[kMostImages * kParts];
    for (int k = 0; k < parts.images() * kParts; ++k)
      shares[k] =
          partInPool(parts.blocks[i], k % kParts, imageOf(parts.mirrors, k / kParts), *sides_F);
    visit(PartBlocks{parts.blocks + i, 1, parts.mirrors, shares});
  }
}

}  // namespace

WettedParts::WettedParts(const FluidBody& body, std::shared_ptr<const AddedMassParts> parts)
    : WettedInertia(body.added_mass),
      parts_(std::move(parts)),
      defect_(body.added_mass - parts_->sum()),
      volume_(body.volume) {}

Matrix6 WettedParts::inertiaAt(const Immersion& at) const noexcept {
  PartInertia sum{};
  forBlocksInPool(parts_->blocks(), at.plane.sides_F, [&](const PartBlocks& blocks) {
    const PartInertia more = kPartKernels.fastest()->inertia(blocks, planeOf(at));
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
    const PartGradient g = kPartKernels.fastest()->gradient(blocks, planeOf(at), products);
    sum.by_height += 0.5 * g.by_height;
    sum.by_normal += 0.5 * Vector3(g.by_normal[0], g.by_normal[1], g.by_normal[2]);
  });
  return sum;
}

namespace {

double immersionOf(const Immersion& at) { return at.draught() / at.size(); }

/// Point whose depth the added mass depends on: centroid of the waterplane, else of the wet volume.
Vector3 placeOfChange(const WetVolume& wet) {
  return wet.waterplane.area > 0 ? wet.waterplane.centroid : Vector3(wet.moment / wet.volume);
}

}  // namespace

WettedTable::WettedTable(std::shared_ptr<const FluidBody> body,
                         std::shared_ptr<const AddedMassParts> parts,
                         std::shared_ptr<const PackedHull> hull)
    : WettedParts(*body, std::move(parts)),
      body_(std::move(body)),
      hull_(std::move(hull)),
      lattice_(body_->waterline.subdivisions),
      nodes_(body_->waterline.immersions) {
  AMBIENT_ASSERT(hull_ && !nodes_.empty() && nodes_.front() > 0 &&
                 nodes_.back() < WaterlineTable::kDeep);
  nodes_.push_back(WaterlineTable::kDeep);
}

WettedTable::Touch WettedTable::touchAt(const Immersion& immersion) const noexcept {
  Touch touch{immersion};
  const double draught = nodes_.front() * immersion.size(),
               immersion_ratio = immersion.draught() / draught;
  if (!(immersion_ratio < 1)) return touch;
  touch.at.plane.height = immersion.low + draught;
  touch.at.wet = computeWetVolume(*hull_, touch.at.plane);
  touch.factor = immersion_ratio * immersion_ratio;
  touch.slope = 2 * immersion_ratio / draught;
  return touch;
}

// Cubic between two nodes. Slope at a node: that of the parabola through the node and its two
// neighbours; first node: slope of the chord; last node: 0. @pre immersion >= first node
WettedTable::Weights WettedTable::weightsAt(double immersion) const noexcept {
  AMBIENT_ASSERT(!(immersion < nodes_.front() * (1 - 1e-9)));
  const auto next = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, immersion);
  const auto k = static_cast<int>(next - nodes_.begin()) - 1;
  const double width = nodes_[k + 1] - nodes_[k];
  const double t = std::clamp((immersion - nodes_[k]) / width, 0.0, 1.0), u = 1 - t;
  Weights weights{k - 1, {0, u * u * (1 + 2 * t), t * t * (1 + 2 * u), 0}, {}};
  weights.of_slope[1] = -6 * t * u / width;
  weights.of_slope[2] = -weights.of_slope[1];
  const auto addSlope = [&](int i, double to_value, double to_slope) {
    double slopes[3] = {0, -1, 1};
    const int node = k + i;
    const double after = nodes_[node + 1] - nodes_[node];
    if (node > 0) {
      const double before = nodes_[node] - nodes_[node - 1], both = before + after;
      slopes[0] = -after / (before * both);
      slopes[1] = (after - before) / (before * after);
      slopes[2] = before / (after * both);
    } else {
      slopes[1] = -1 / after;
      slopes[2] = 1 / after;
    }
    for (int j = 0; j < 3; ++j) {
      weights.of_value[i + j] += to_value * slopes[j];
      weights.of_slope[i + j] += to_slope * slopes[j];
    }
  };
  addSlope(0, width * t * u * u, u * (u - 2 * t));
  if (k + 2 < static_cast<int>(nodes_.size())) addSlope(1, -width * t * t * u, t * (t - 2 * u));
  return weights;
}

Matrix6 WettedTable::interpolate(const Vector3& normal, int first,
                                 const double (&weights)[4]) const noexcept {
  const std::vector<Matrix6>& corrections = body_->waterline.corrections;
  const std::size_t count = nodes_.size() - 1;  // the last one has no correction
  AMBIENT_ASSERT(isUnit(normal));
  const OctahedralLattice::Corners corners = lattice_.cornersAround(normal);
  Matrix6 sum = Matrix6::Zero();
  for (int corner = 0; corner < 3; ++corner)
    for (int i = 0; i < 4; ++i) {
      const int node = first + i;
      if (node < 0 || node >= static_cast<int>(count)) continue;
      sum += corners.weight[corner] * weights[i] * corrections[corners.node[corner] * count + node];
    }
  return sum;
}

double WettedTable::shareInPool(const Immersion& at) const noexcept {
  if (!at.plane.sides_F) return 1;
  SurfacePlane open = at.plane;
  open.sides_F = nullptr;
  const double whole = computeWetVolume(*hull_, open).volume;
  return whole > 0 ? std::clamp(at.wet.volume / whole, 0.0, 1.0) : 0;
}

Matrix6 WettedTable::inertiaOf(const Touch& touch) const noexcept {
  const Immersion& at = touch.at;
  const Weights weights = weightsAt(immersionOf(at));
  return touch.factor *
         (WettedParts::inertiaAt(at) +
          shareInPool(at) * interpolate(at.plane.normal, weights.first, weights.of_value));
}

Matrix6 WettedTable::inertiaAt(const Immersion& at) const noexcept {
  return inertiaOf(touchAt(at));
}

InertiaGradient WettedTable::gradientAt(const Immersion& at, const Twist& twist) const noexcept {
  if (!(at.wet.volume > 0)) return {};
  const Vector6 x = twist.vector();
  const Touch touch = touchAt(at);
  if (touch.slope > 0) {
    const double by_height = 0.5 * touch.slope / touch.factor * x.dot(inertiaOf(touch) * x);
    return {by_height, -by_height * placeOfChange(at.wet)};
  }
  InertiaGradient gradient = WettedParts::gradientAt(at, twist);
  const Weights weights = weightsAt(immersionOf(at));
  const Matrix6 slope = interpolate(at.plane.normal, weights.first, weights.of_slope);
  const double by_height = 0.5 * shareInPool(at) * x.dot(slope * x) / at.size();
  gradient.by_height += by_height;
  gradient.by_normal -= by_height * placeOfChange(at.wet);
  return gradient;
}

namespace {

/// Added mass times the wet share of the volume: approximation for a body without parts.
class WettedShare final : public WettedInertia {
 public:
  explicit WettedShare(const FluidBody& body)
      : WettedInertia(body.added_mass), volume_(body.volume) {}

 private:
  Matrix6 inertiaAt(const Immersion& at) const noexcept override {
    return wetShare(at, volume_) * deep();
  }
  InertiaGradient gradientAt(const Immersion& at, const Twist& twist) const noexcept override {
    if (!(volume_ > 0)) return {};
    const Vector6 x = twist.vector();
    const Waterplane& plane = at.wet.waterplane;
    const double by_height = 0.5 * x.dot(deep() * x) * plane.area / volume_;
    return {by_height, -by_height * plane.centroid};
  }

  double volume_;
};

}  // namespace

std::shared_ptr<const WettedInertia> makeWettedInertia(
    const std::shared_ptr<const FluidBody>& body) {
  const LoadTables tables(body);
  return tables.wettedInertia([&]() -> std::shared_ptr<const WettedInertia> {
    if (body->sphere_radius > 0) return std::make_shared<WettedSphere>(*body);
    if (body->added_mass_parts.empty()) return std::make_shared<WettedShare>(*body);
    const std::shared_ptr<const AddedMassParts> parts{body, &body->added_mass_parts};
    if (!body->waterline.empty()) return std::make_shared<WettedTable>(body, parts, tables.hull());
    return std::make_shared<WettedParts>(*body, parts);
  });
}

}  // namespace ambient
