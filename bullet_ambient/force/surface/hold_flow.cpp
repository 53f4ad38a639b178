#include "bullet_ambient/force/surface/hold_flow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

constexpr double kDischarge = 0.6;  // C: 0.58 of a broad crest, 0.61 of a sharp one
constexpr std::size_t kEdges = 32, kPieces = 64;

using Corners = std::array<Vector3, 3>;

double areaOf(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2; }

/// Halves a triangle across its longest side.
std::array<Corners, 2> halved(const Corners& t) {
  std::size_t longest = 0;
  const auto side = [&](std::size_t k) { return (t[(k + 1) % 3] - t[k]).squaredNorm(); };
  for (const std::size_t k : {1, 2})
    if (side(k) > side(longest)) longest = k;
  const Vector3 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
  const Vector3 middle = (a + b) / 2;
  return {{{a, middle, c}, {middle, b, c}}};
}

/// Flows in both directions [m^3/s].
struct BothWays {
  double forth = 0, back = 0;

  void add(double flow) { (flow > 0 ? forth : back) += std::abs(flow); }
};

/// Over a crest, per C sqrt(2g) and length, from a depth of water to another one: eq. (138).
double overCrest(double from, double to) {
  const double head = std::abs(from - to), root = std::sqrt(head);
  const double flow = root * (2.0 / 3 * head + std::min(from, to));
  return from > to ? flow : -flow;
}

/// Heights on both sides of an opening [m].
struct Levels {
  double from, to;
  const double *from_rises = nullptr, *to_rises = nullptr;  ///< WaterSide::rises

  double fromAt(std::size_t edge) const { return from_rises ? from + from_rises[edge] : from; }
  double toAt(std::size_t edge) const { return to_rises ? to + to_rises[edge] : to; }
};

/// Through the pieces of a lid, per C sqrt(2g): eq. (139). `air`: as of sealedFlowThrough().
BothWays throughPieces(const OpeningShape& opening, const Vector3& normal, const Levels& levels,
                       double air) {
  BothWays flow;
  for (const OpeningShape::Piece& piece : opening.pieces()) {
    const double height = normal.dot(piece.place);
    const double from = std::max(0.0, levels.fromAt(piece.edge) - height),
                 to = std::max(0.0, levels.toAt(piece.edge) - height), head = from - to - air;
    if ((head > 0 ? from : to) > 0)
      flow.add(std::copysign(piece.area * std::sqrt(std::abs(head)), head));
  }
  return flow;
}

}  // namespace

OpeningShape::OpeningShape(const HoldOpening& opening) {
  for (std::size_t i = 0; i < opening.outline.size(); i += 3)
    corners_.emplace_back(opening.outline[i], opening.outline[i + 1], opening.outline[i + 2]);
  Vector3 low = corners_.front(), high = low;
  for (const Vector3& corner : corners_) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  middle_ = (low + high) / 2;
  half_ = (high - low) / 2;
  std::vector<Vector3> outline = corners_;
  while (outline.size() < kEdges) {
    std::vector<Vector3> finer;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      finer.push_back(outline[i]);
      finer.emplace_back((outline[i] + outline[(i + 1) % outline.size()]) / 2);
    }
    outline = std::move(finer);
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    edges_.push_back({(a + b) / 2, b - a});
  }
  std::vector<Corners> triangles;
  const auto corner = [&](std::size_t i) {
    return corners_[static_cast<std::size_t>(opening.lid[i])];
  };
  for (std::size_t i = 0; i < opening.lid.size(); i += 3)
    triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
  while (triangles.size() < kPieces) {
    const auto largest =
        std::max_element(triangles.begin(), triangles.end(),
                         [](const Corners& a, const Corners& b) { return areaOf(a) < areaOf(b); });
    const std::array<Corners, 2> halves = halved(*largest);
    *largest = halves[0];
    triangles.push_back(halves[1]);
  }
  for (const Corners& t : triangles) {
    const Vector3 place = (t[0] + t[1] + t[2]) / 3;
    const auto nearest =
        std::min_element(edges_.begin(), edges_.end(), [&](const Edge& a, const Edge& b) {
          return (a.middle - place).squaredNorm() < (b.middle - place).squaredNorm();
        });
    pieces_.push_back({place, areaOf(t), static_cast<std::size_t>(nearest - edges_.begin())});
    outward_ += (t[1] - t[0]).cross(t[2] - t[0]) / 2;
  }
}

double OpeningShape::top(const Vector3& normal) const noexcept {
  double top = -std::numeric_limits<double>::infinity();
  for (const Vector3& corner : corners_) top = std::max(top, normal.dot(corner));
  return top;
}

bool OpeningShape::isAbove(double height, const Vector3& normal) const noexcept {
  return normal.dot(middle_) - normal.cwiseAbs().dot(half_) >= height ||
         std::none_of(corners_.begin(), corners_.end(),
                      [&](const Vector3& corner) { return normal.dot(corner) < height; });
}

HoldOpening openingOf(const WallHole& hole) {
  AMBIENT_ASSERT(isUnit(hole.normal) && hole.area > 0);
  constexpr int kCorners = 8;
  const double half = std::sqrt(0.5), radius = std::sqrt(hole.area / (4 * half));
  const double cosines[kCorners] = {1, half, 0, -half, -1, -half, 0, half};
  const PlaneAxes axes(hole.normal);
  HoldOpening opening;
  for (int i = 0; i < kCorners; ++i) {
    const Vector3 corner =
        hole.place + radius * (cosines[i] * axes.first + cosines[(i + 6) % kCorners] * axes.second);
    opening.outline.insert(opening.outline.end(), corner.data(), corner.data() + 3);
    if (i > 1) opening.lid.insert(opening.lid.end(), {0, i - 1, i});
  }
  return opening;
}

double flowThrough(const OpeningShape& opening, const Upward& up, double from_height,
                   double to_height, const double* from_rises, const double* to_rises) noexcept {
  AMBIENT_ASSERT(isUnit(up.normal) && up.gravity >= 0);
  const Levels levels{from_height, to_height, from_rises, to_rises};
  BothWays weir;
  bool is_covered_from = true, is_covered_to = true;
  for (std::size_t i = 0; i < opening.edges().size(); ++i) {
    const OpeningShape::Edge& edge = opening.edges()[i];
    const double height = up.normal.dot(edge.middle);
    const double from = levels.fromAt(i) - height, to = levels.toAt(i) - height;
    weir.add(edge.way.cross(up.normal).norm() * overCrest(std::max(0.0, from), std::max(0.0, to)));
    is_covered_from = is_covered_from && from > 0;
    is_covered_to = is_covered_to && (!to_rises || to > 0);
  }
  const BothWays orifice = throughPieces(opening, up.normal, levels, 0);
  for (const Vector3& corner : opening.corners()) {
    const double height = up.normal.dot(corner);
    is_covered_from = is_covered_from && (from_rises || height < from_height);
    is_covered_to = is_covered_to && (to_rises || height < to_height);
  }
  if (is_covered_from) weir.forth = std::min(weir.forth, orifice.forth);
  if (is_covered_to) weir.back = std::min(weir.back, orifice.back);
  return kDischarge * std::sqrt(2 * up.gravity) * (weir.forth - weir.back);
}

double sealedFlowThrough(const OpeningShape& opening, const Upward& up, double from_height,
                         double to_height, double air) noexcept {
  AMBIENT_ASSERT(isUnit(up.normal) && up.gravity >= 0);
  const BothWays flow = throughPieces(opening, up.normal, {from_height, to_height}, air);
  return kDischarge * std::sqrt(2 * up.gravity) * (flow.forth - flow.back);
}

double bubblingFlow(const OpeningShape& opening, const Upward& up) noexcept {
  constexpr double kBubble = 0.35;  // speed of a bubble that fills a pipe, over sqrt(gD)
  const double across = std::sqrt(4 * opening.outward().norm() / kPi);
  return kBubble * std::abs(opening.outward().dot(up.normal)) * std::sqrt(up.gravity * across);
}

double volumeThrough(const OpeningShape& opening, const Upward& up, const WaterSide& from,
                     const WaterSide& to, double duration) noexcept {
  constexpr double kAccuracy = 1e-12;  // of the explicit step
  AMBIENT_ASSERT(duration >= 0 && from.area > 0 && to.area > 0);
  // Returns the flow at the levels that a volume q leaves, times the duration, less q. Falls with
  // q.
  const auto excess = [&](double q) {
    return duration * flowThrough(opening, up, from.height - q / from.area, to.height + q / to.area,
                                  from.rises, to.rises) -
           q;
  };
  const double first = excess(0);
  const double end =
      std::clamp(first, -std::min(to.volume, from.room), std::min(from.volume, to.room));
  if (end == 0) return 0;
  const double at_far = excess(end);
  if (at_far == 0 || (at_far > 0) == (first > 0)) return end;
  return fallingRoot(0, first, end, at_far, kAccuracy * std::abs(first), excess);
}

double SealedAir::productAfter(double inflow, double level, const Outside& outside) const noexcept {
  const double left = volume - inflow;
  AMBIENT_ASSERT(outside.atmosphere > 0 && outside.weight > 0);
  double after = product;
  if (most < std::numeric_limits<double>::infinity())
    after = std::min(after, most * std::max(left, kept));
  if (inlet < std::numeric_limits<double>::infinity()) {
    const double submergence = std::max(0.0, level - inlet);
    after = std::max(after, (outside.atmosphere - outside.weight * submergence) * left);
  }
  return after;
}

double SealedAir::headAfter(double inflow, double level, const Outside& outside) const noexcept {
  const double left = std::max(volume - inflow, std::numeric_limits<double>::min());
  const double pressure = productAfter(volume - left, level, outside) / left;
  return (pressure - outside.atmosphere) / outside.weight;
}

}  // namespace ambient
