#include "preprocess/mesh/wings/wing_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/body_parts.h"

namespace ambient {
namespace {

/// Section of a wing across its span: the lines in which a plane cuts it. First coordinate along
/// the chord, second one across the wing.
class Section {
 public:
  void add(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    lines_.emplace_back(from, to);
    for (const Eigen::Vector2d& end : {from, to}) {
      low_ = std::min(low_, end.x());
      high_ = std::max(high_, end.x());
    }
  }

  double chord() const { return lines_.empty() ? 0 : high_ - low_; }

  /// Lower and upper side at a share of the chord from its low end; low > high where there is none.
  std::pair<double, double> sidesAt(double share) const {
    const double x = low_ + share * (high_ - low_);
    std::pair<double, double> sides{kNone, -kNone};
    for (const auto& [from, to] : lines_) {
      if ((from.x() < x) == (to.x() < x)) continue;
      const double y = from.y() + (x - from.x()) / (to.x() - from.x()) * (to.y() - from.y());
      sides.first = std::min(sides.first, y);
      sides.second = std::max(sides.second, y);
    }
    return sides;
  }
  double thicknessAt(double share) const {
    const auto [lower, upper] = sidesAt(share);
    return std::max(upper - lower, 0.0);
  }
  double middleAt(double share) const {
    const auto [lower, upper] = sidesAt(share);
    return (lower + upper) / 2;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> lines_;
  double low_ = kNone, high_ = -kNone;
};

Section sectionAt(const TriangleMesh& mesh, const std::vector<Eigen::Index>& triangles,
                  const Wing& wing, double place) {
  const Vector3 &z = wing.facing, &h = wing.span_axis, x = h.cross(z);
  const Vector3 middle = wing.centre + place * wing.span * h;
  Section section;
  for (const Eigen::Index t : triangles) {
    std::array<Vector3, 3> corners;
    std::array<double, 3> heights{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = Vector3(mesh.corner(t, static_cast<int>(k))) - middle;
      heights[k] = h.dot(corners[k]);
    }
    std::vector<Eigen::Vector2d> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if ((heights[k] < 0) == (heights[next] < 0)) continue;
      const double share = heights[k] / (heights[k] - heights[next]);
      const Vector3 end = corners[k] + share * (corners[next] - corners[k]);
      ends.emplace_back(x.dot(end), z.dot(end));
    }
    if (ends.size() == 2) section.add(ends[0], ends[1]);
  }
  return section;
}

/// 1 or -1: the end of the chord that is round, where the other one is thin; kRoundAtBothEnds; 0:
/// neither.
double noseOf(const Section& section) {
  constexpr double kNear = 0.05;                    // of the chord from an end
  constexpr double kRoundest = 0.9, kRound = 0.35;  // thickness there over the largest one
  constexpr double kThin = 0.3;
  double most = 0;
  for (int i = 1; i < 20; ++i) most = std::max(most, section.thicknessAt(i / 20.0));
  const double low = section.thicknessAt(kNear), high = section.thicknessAt(1 - kNear);
  const auto isRound = [&](double t) { return t > kRound * most && t < kRoundest * most; };
  if (isRound(low) && isRound(high)) return kRoundAtBothEnds;
  if (isRound(high) && low < kThin * most) return 1;
  return isRound(low) && high < kThin * most ? -1 : 0;
}

/// Incidence without lift of the mean line by the theory of thin aerofoils, to the chord's axis, of
/// a section whose nose is at its high end (1) or low end (-1) [rad].
double incidenceWithoutLift(const Section& section, double nose) {
  constexpr int kSteps = 32;
  constexpr double kEnd = 1e-6;  // of the chord: a line meets the section there
  const auto middleAt = [&](int i) {
    const double behind = (1 - portable::cos(kPi * i / kSteps)) / 2;
    const double share = nose > 0 ? 1 - behind : behind;
    return section.middleAt(std::clamp(share, kEnd, 1 - kEnd));
  };
  double sum = 0, before = middleAt(0);
  for (int i = 0; i < kSteps; ++i) {
    const double after = middleAt(i + 1), half_angle = kPi * (i + 0.5) / (2 * kSteps);
    const auto [sine, cosine] = portable::sineAndCosine(half_angle);
    sum += (after - before) * 2 * sine / cosine;
    before = after;
  }
  return sum / (kPi * section.chord());
}

/// The same of a section with any nose: of one that is round at both ends the mean of both ways.
double meanIncidenceWithoutLift(const Section& section, double nose) {
  if (nose != kRoundAtBothEnds) return incidenceWithoutLift(section, nose);
  return (incidenceWithoutLift(section, 1) + incidenceWithoutLift(section, -1)) / 2;
}

}  // namespace

void setSection(const TriangleMesh& mesh, const std::vector<Eigen::Index>& triangles, Wing& wing) {
  constexpr double kThinnest = 0.04;  // of the chord: a thinner nose is an edge
  constexpr double kLeastCamber = 0.005;
  constexpr int kSections = 7;
  if (!(wing.thickness > kThinnest * wing.chord)) return;
  double noses = 0, both = 0, chords = 0, angles = 0;
  for (int i = 0; i < kSections; ++i) {
    const double place = (i + 1) / (kSections + 1.0) - 0.5;
    const Section section = sectionAt(mesh, triangles, wing, place);
    const double nose = noseOf(section);
    if (nose == 0) continue;
    if (nose == kRoundAtBothEnds)
      both += 1;
    else
      noses += nose;
    chords += section.chord();
    angles += section.chord() * meanIncidenceWithoutLift(section, nose);
  }
  constexpr double kMost = 2.0 / 3;
  const double camber = chords > 0 ? -angles / chords / 2 : 0;
  const bool is_both = both >= kMost * kSections;
  if (std::abs(noses) < kMost * kSections && !is_both) return;
  if (!(std::abs(camber) <= kMostCamber)) return;
  wing.nose = is_both ? kRoundAtBothEnds : std::copysign(1.0, noses);
  if (std::abs(camber) > kLeastCamber) wing.camber = camber;
}

}  // namespace ambient
