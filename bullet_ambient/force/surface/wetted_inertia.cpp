#include "bullet_ambient/force/surface/wetted_inertia.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/force/kernels/part_sums.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

namespace {

/// Rise of the water around an entering body [m], docs/theory.md eq. (65), and its derivative by
/// the height of the plane [1].
struct PileUp {
  double rise = 0, slope = 0;

  explicit PileUp(const Immersion& at) {
    constexpr double kPileUp = 0.4;
    if (!(at.draught() < at.size())) return;
    const double wet = at.draught() / at.size(), dry = 1 - wet;
    const double dry7 = dry * dry * dry * (dry * dry) * (dry * dry);
    rise = kPileUp * dry7 * dry * at.draught();
    slope = kPileUp * dry7 * (dry - 8 * wet);
  }
};

Immersion raised(const Immersion& immersion, const PileUp& pile_up) {
  Immersion result = immersion;
  result.plane.height += pile_up.rise;
  return result;
}

}  // namespace

double wetShare(const Immersion& immersion, double volume) noexcept {
  AMBIENT_ASSERT(volume >= 0 && !(immersion.low > immersion.high));
  const double share =
      volume > 0 ? immersion.wet.volume / volume : immersion.draught() / immersion.size();
  return std::clamp(share, 0.0, 1.0);
}

Matrix6 WettedInertia::inertia(const Immersion& immersion) const noexcept {
  AMBIENT_ASSERT(isUnit(immersion.plane.normal));
  AMBIENT_ASSERT(isSymmetric(deep_, 1e-6));
  if (immersion.isDry()) return Matrix6::Zero();
  return immersion.isDeep() ? deep_ : inertiaAt(raised(immersion, PileUp(immersion)));
}

Matrix6 WettedInertia::unraisedInertia(const Immersion& immersion) const noexcept {
  if (immersion.isDry()) return Matrix6::Zero();
  return immersion.isDeep() ? deep_ : inertiaAt(immersion);
}

InertiaGradient WettedInertia::gradient(const Immersion& immersion,
                                        const Twist& twist) const noexcept {
  if (immersion.isDry() || immersion.isDeep()) return {};
  const PileUp pile_up(immersion);
  InertiaGradient gradient = gradientAt(raised(immersion, pile_up), twist);
  if (pile_up.slope == 0 || !(immersion.wet.volume > 0)) return gradient;
  // The rise depends on the lowest point, taken to lie along s below the centre of buoyancy.
  const double by_rise = pile_up.slope * gradient.by_height;
  gradient.by_height += by_rise;
  gradient.by_normal -= by_rise * (immersion.wet.moment / immersion.wet.volume);
  return gradient;
}

namespace {

// Added mass by boundary elements with the negative image; unit: radius; scaled to pi/3 at depth 1.
constexpr double kDepths[] = {0.02, 0.07, 0.10, 0.20, 0.30, 0.40, 0.60, 0.80, 0.90,
                              1.00, 1.20, 1.40, 1.60, 1.80, 2.00, 2.20, 2.70, 4.00};
constexpr double kAlong[] = {0.0097, 0.0581, 0.0943, 0.2343, 0.3850, 0.5262,
                             0.7650, 0.9410, 1.0015, 1.0472, 1.1049, 1.1400,
                             1.1897, 1.2917, 1.4922, 1.7062, 1.9546, 2.0804};
constexpr double kAcross[] = {0.0001, 0.0012, 0.0027, 0.0149, 0.0395, 0.0772,
                              0.1924, 0.3612, 0.4655, 0.5759, 0.8210, 1.0821,
                              1.3449, 1.5836, 1.7738, 1.8966, 2.0284, 2.0921};
constexpr int kNodes = std::size(kDepths);
constexpr double kFree = 2 * kPi / 3;  // added mass in unbounded fluid
constexpr double kDeep = 6;            // depth from which on the surface is ignored

struct Value {
  double value, slope;
};

/// Interpolates by monotone cubics over the root of the depth (Fritsch and Carlson 1980). Above the
/// first node: a power of the depth, 3/2 along the normal, as for the disc that first gets wet.
class Column {
 public:
  Column(const double (&values)[kNodes], double power) : values_(values), power_(power) {
    for (int i = 0; i < kNodes; ++i) nodes_[i] = std::sqrt(kDepths[i]);
    slopes_[0] = 2 * power * values[0] / nodes_[0];
    for (int i = 1; i + 1 < kNodes; ++i) slopes_[i] = slopeAt(i);
    slopes_[kNodes - 1] = 2 * nodes_[kNodes - 1] * atDepth(kDepths[kNodes - 1]).slope;
  }

  Value at(double depth) const {
    if (depth >= kDepths[kNodes - 1]) return atDepth(depth);
    if (depth <= kDepths[0]) return atTouch(depth);
    const double x = std::sqrt(depth);
    const auto next = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, x);
    const auto i = static_cast<int>(next - nodes_.begin()) - 1;
    const double h = nodes_[i + 1] - nodes_[i], t = (x - nodes_[i]) / h;
    const double rise = values_[i + 1] - values_[i];
    const double a = h * slopes_[i] - rise, b = rise - h * slopes_[i + 1];
    const double value = values_[i] + t * (rise + (1 - t) * (a * (1 - t) + b * t));
    const double slope = (rise + (1 - 2 * t) * (a * (1 - t) + b * t) + t * (1 - t) * (b - a)) / h;
    return {value, slope / (2 * x)};
  }

 private:
  double secant(int i) const { return (values_[i + 1] - values_[i]) / (nodes_[i + 1] - nodes_[i]); }
  double slopeAt(int i) const {
    const double before = nodes_[i] - nodes_[i - 1], after = nodes_[i + 1] - nodes_[i];
    const double w = 2 * after + before, v = after + 2 * before;
    return (w + v) / (w / secant(i - 1) + v / secant(i));
  }
  Value atTouch(double depth) const {
    const double part = portable::pow(depth / kDepths[0], power_ - 1) / kDepths[0];
    return {values_[0] * depth * part, power_ * values_[0] * part};
  }
  // Below the last node: the image acts like a dipole at twice the depth of the centre.
  Value atDepth(double depth) const {
    const double last = kDepths[kNodes - 1] - 1, deep = kDeep - 1, x = std::min(depth, kDeep) - 1;
    const auto cubed = [](double a) { return 1 / (a * a * a); };
    const double missing = (kFree - values_[kNodes - 1]) / (cubed(last) - cubed(deep));
    return {kFree - missing * (cubed(x) - cubed(deep)),
            depth < kDeep ? 3 * missing * cubed(x) / x : 0};
  }

  const double (&values_)[kNodes];
  double power_;
  std::array<double, kNodes> nodes_, slopes_;
};

}  // namespace

SphereInertia sphereInertiaAt(double depth) noexcept {
  static const Column along(kAlong, 1.5), across(kAcross, 2);
  const double d = std::max(0.0, depth);
  const Value a = along.at(d), c = across.at(d);
  AMBIENT_ASSERT(!(a.value < 0) && !(c.value < 0));
  return {a.value, c.value, a.slope, c.slope};
}

namespace {

/// Added mass of a sphere at the surface.
class WettedSphere final : public WettedInertia {
 public:
  explicit WettedSphere(const FluidBody& body)
      : WettedInertia(body.added_mass),
        centre_(body.centre_of_volume),
        radius_(body.sphere_radius),
        cube_(radius_ * radius_ * radius_) {}

 private:
  Matrix6 inertiaAt(const Immersion& at) const noexcept override {
    const SphereInertia k = sphereInertiaAt(at.draught() / radius_);
    const Vector3& s = at.plane.normal;
    Matrix6 about_centre = Matrix6::Zero();
    about_centre.bottomRightCorner<3, 3>() =
        cube_ * (k.across * Matrix3::Identity() + (k.along - k.across) * s * s.transpose());
    return shiftOrigin(about_centre, -centre_);
  }

  InertiaGradient gradientAt(const Immersion& at, const Twist& twist) const noexcept override {
    const SphereInertia k = sphereInertiaAt(at.draught() / radius_);
    const Vector3& s = at.plane.normal;
    const Vector3 v = twist.at(centre_);
    const double rise = s.dot(v);
    const double by_height =
        0.5 * cube_ / radius_ *
        (k.across_slope * v.squaredNorm() + (k.along_slope - k.across_slope) * rise * rise);
    // The depth of the lowest point is h - s.c + R.
    return {by_height, cube_ * (k.along - k.across) * rise * v - by_height * centre_};
  }

  Vector3 centre_;
  double radius_, cube_;
};

/// Plane with the reach kappa H of the weights; kappa fades to 0 at a deep body, eq. (61).
PartPlane partPlaneOf(const Immersion& at) {
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

double immersionOf(const Immersion& at) { return at.draught() / at.size(); }

/// Point whose depth the added mass depends on: centroid of the waterplane, else of the wet volume.
Vector3 placeOfChange(const WetVolume& wet) {
  return wet.waterplane.area > 0 ? wet.waterplane.centroid : Vector3(wet.moment / wet.volume);
}

/// Added mass at the surface by the parts of the added mass in unbounded fluid, weighted by their
/// depth; docs/theory.md eq. (60), (61).
class WettedParts : public WettedInertia {
 public:
  WettedParts(const FluidBody& body, std::shared_ptr<const AddedMassParts> parts)
      : WettedInertia(body.added_mass),
        parts_(std::move(parts)),
        defect_(body.added_mass - parts_->sum()),
        volume_(body.volume) {}

 protected:
  Matrix6 inertiaAt(const Immersion& at) const noexcept override {
    PartInertia sum{};
    forBlocksInPool(parts_->blocks(), at.plane.sides_F, [&](const PartBlocks& blocks) {
      const PartInertia more = kPartKernels.fastest()->inertia(blocks, partPlaneOf(at));
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

  InertiaGradient gradientAt(const Immersion& at, const Twist& twist) const noexcept override {
    const Vector6 x = twist.vector();
    double products[PartBlock::kEntries];
    int entry = 0;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        products[entry++] = (row == column ? 1 : 2) * x[row] * x[column];
    InertiaGradient sum;
    forBlocksInPool(parts_->blocks(), at.plane.sides_F, [&](const PartBlocks& blocks) {
      const PartGradient g = kPartKernels.fastest()->gradient(blocks, partPlaneOf(at), products);
      sum.by_height += 0.5 * g.by_height;
      sum.by_normal += 0.5 * Vector3(g.by_normal[0], g.by_normal[1], g.by_normal[2]);
    });
    return sum;
  }

 private:
  std::shared_ptr<const AddedMassParts> parts_;
  Matrix6 defect_;  ///< added mass minus the sum of the parts
  double volume_;
};

/// Added mass at the surface: WettedParts plus the correction of a waterline table; docs/theory.md
/// eq. (61a).
class WettedTable final : public WettedParts {
 public:
  /// @pre the body has a waterline table; `parts` and `hull` belong to the body
  WettedTable(std::shared_ptr<const FluidBody> body, std::shared_ptr<const AddedMassParts> parts,
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

 private:
  Matrix6 inertiaAt(const Immersion& at) const noexcept override { return inertiaOf(touchAt(at)); }

  /// Gradient; the correction counts as a function of the depth of the waterplane's centroid only.
  InertiaGradient gradientAt(const Immersion& at, const Twist& twist) const noexcept override {
    if (!(at.wet.volume > 0)) return {};
    const Vector6 x = twist.vector();
    const Touch touch = touchAt(at);
    if (touch.slope > 0) {
      const double by_height = 0.5 * touch.slope / touch.factor * x.dot(inertiaOf(touch) * x);
      return {by_height, -by_height * placeOfChange(at.wet)};
    }
    InertiaGradient gradient = WettedParts::gradientAt(at, twist);
    const NodeWeights weights = weightsAt(immersionOf(at));
    const Matrix6 slope = interpolate(at.plane.normal, weights.first, weights.of_slope);
    const double by_height = 0.5 * shareInPool(at) * x.dot(slope * x) / at.size();
    gradient.by_height += by_height;
    gradient.by_normal -= by_height * placeOfChange(at.wet);
    return gradient;
  }

  /// Cubic interpolation: index of the first of four nodes, weights of value and slope.
  struct NodeWeights {
    int first;
    double of_value[4], of_slope[4];
  };
  /// State of a body whose immersion is below the first node of the table. Its added mass is that
  /// at the first node times a factor, which grows with the square of the depth, as for a wedge.
  struct Touch {
    Immersion at;       ///< immersion at the first node, or the body's own if that is deeper
    double factor = 1;  ///< factor on the added mass at `at`
    double slope = 0;   ///< d factor / d height of the plane [1/m]; 0: deeper than the first node
  };
  Touch touchAt(const Immersion& immersion) const noexcept {
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

  /// Share of the wet volume that is between the sides of the pool; 1 where it has none.
  double shareInPool(const Immersion& at) const noexcept {
    if (!at.plane.sides_F) return 1;
    SurfacePlane open = at.plane;
    open.sides_F = nullptr;
    const double whole = computeWetVolume(*hull_, open).volume;
    return whole > 0 ? std::clamp(at.wet.volume / whole, 0.0, 1.0) : 0;
  }

  Matrix6 inertiaOf(const Touch& touch) const noexcept {
    const Immersion& at = touch.at;
    const NodeWeights weights = weightsAt(immersionOf(at));
    return touch.factor *
           (WettedParts::inertiaAt(at) +
            shareInPool(at) * interpolate(at.plane.normal, weights.first, weights.of_value));
  }

  // Cubic between two nodes. Slope at a node: that of the parabola through the node and its two
  // neighbours; first node: slope of the chord; last node: 0. @pre immersion >= first node
  NodeWeights weightsAt(double immersion) const noexcept {
    AMBIENT_ASSERT(!(immersion < nodes_.front() * (1 - 1e-9)));
    const auto next = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, immersion);
    const auto k = static_cast<int>(next - nodes_.begin()) - 1;
    const double width = nodes_[k + 1] - nodes_[k];
    const double t = std::clamp((immersion - nodes_[k]) / width, 0.0, 1.0), u = 1 - t;
    NodeWeights weights{k - 1, {0, u * u * (1 + 2 * t), t * t * (1 + 2 * u), 0}, {}};
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

  Matrix6 interpolate(const Vector3& normal, int first, const double (&weights)[4]) const noexcept {
    const std::vector<Matrix6>& corrections = body_->waterline.corrections;
    const std::size_t count = nodes_.size() - 1;  // the last one has no correction
    AMBIENT_ASSERT(isUnit(normal));
    const OctahedralLattice::Corners corners = lattice_.cornersAround(normal);
    Matrix6 sum = Matrix6::Zero();
    for (int corner = 0; corner < 3; ++corner)
      for (int i = 0; i < 4; ++i) {
        const int node = first + i;
        if (node < 0 || node >= static_cast<int>(count)) continue;
        sum +=
            corners.weight[corner] * weights[i] * corrections[corners.node[corner] * count + node];
      }
    return sum;
  }

  std::shared_ptr<const FluidBody> body_;
  std::shared_ptr<const PackedHull> hull_;
  OctahedralLattice lattice_;
  std::vector<double> nodes_;  ///< immersions of the table, then kDeep
};

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
