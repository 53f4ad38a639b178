#include "preprocess/mesh/wings/wing_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/body_parts.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/wings/triangle_tree.h"

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

/// Sets nose and camber of a wing whose sections are aerofoils: round at one end of the chord, thin
/// at the other one, docs/theory.md eq. (161a), or round at both, eq. (161e). Cost O(T).
/// @param mesh a closed body
/// @param triangles of it that are the wing
/// @param wing measured but for these two, which are 0
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

using Eigen::Vector3d;

/// Sum over a set, its first moment and its second one.
struct WeightedPlaces {
  double sum = 0;
  Vector3 first{0, 0, 0};
  Matrix3 second = Matrix3::Zero();

  /// Adds `weight` spread over points with a mean and a spread about it.
  void add(double weight, const Vector3& mean, const Matrix3& spread) {
    sum += weight;
    first += weight * mean;
    second += weight * (mean * mean.transpose() + spread);
  }
  Vector3 mean() const { return first / sum; }
  Matrix3 variance() const { return second / sum - mean() * mean().transpose(); }
};

/// Edge that a wing shares with another part.
struct JointEdge {
  Vector3 from, to;
  bool is_with_rest;
};

Matrix3 spreadOfTriangle(const TriangleMesh& mesh, Eigen::Index t) {
  Matrix3 spread = Matrix3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vector3 r = Vector3(mesh.corner(t, k) - mesh.barycentre(t));
    spread += r * r.transpose() / 12;
  }
  return spread;
}

/// Edges that wings share with other parts, by label.
std::vector<std::vector<JointEdge>> jointsOf(const TriangleMesh& mesh,
                                             const std::vector<std::uint8_t>& labels) {
  std::vector<std::vector<JointEdge>> joints(kMostWings + 1);
  const MeshEdges edges = computeMeshEdges(mesh);
  for (const auto& [one, other] : edgePairs(edges)) {
    const std::uint8_t a = labels[static_cast<std::size_t>(one.triangle)];
    const std::uint8_t b = labels[static_cast<std::size_t>(other.triangle)];
    if (a == b) continue;
    const Vector3 from = Vector3d(mesh.vertices.col(one.low));
    const Vector3 to = Vector3d(mesh.vertices.col(one.high));
    joints[a].push_back({from, to, b == 0});
    joints[b].push_back({from, to, a == 0});
  }
  return joints;
}

class WingMeasure {
 public:
  WingMeasure(const TriangleMesh& mesh, const TriangleTree* rays) : mesh_(mesh), rays_(rays) {}

  /// Measures the wing that consists of these triangles.
  MeasuredWing of(const std::vector<Eigen::Index>& triangles,
                  const std::vector<JointEdge>& joint) const {
    MeasuredWing measured;
    Wing& wing = measured.wing;
    wing.facing = facingOf(triangles);
    WeightedPlaces planform;
    for (const Eigen::Index t : triangles)
      planform.add(std::abs(Vector3(mesh_.twiceArea(t)).dot(wing.facing)) / 2,
                   Vector3(mesh_.barycentre(t)), spreadOfTriangle(mesh_, t));
    if (!(planform.sum > 0)) throw std::runtime_error("a wing has no area");
    wing.centre = planform.mean();
    wing.thickness = rays_ ? thicknessOf(triangles, wing) / (planform.sum / 2) : 0;
    const Matrix3 variance = planform.variance();
    if (!setJoint(joint, variance, measured)) setFree(variance, wing);
    if (rays_) setSection(mesh_, triangles, wing);
    return measured;
  }

 private:
  Vector3 facingOf(const std::vector<Eigen::Index>& triangles) const {
    Matrix3 normals = Matrix3::Zero();
    for (const Eigen::Index t : triangles) {
      const Vector3 normal(mesh_.twiceArea(t));
      if (normal.norm() > 0) normals += normal * normal.transpose() / normal.norm();
    }
    return symmetricEigen<3>(normals).vectors.col(2);
  }

  /// Volume between the sides of a wing, up to its joint [m^3].
  double thicknessOf(const std::vector<Eigen::Index>& triangles, const Wing& wing) const {
    double volume = 0;
    for (const Eigen::Index t : triangles)
      volume += Vector3(mesh_.twiceArea(t)).dot(wing.facing) / 2 *
                wing.facing.dot(Vector3(mesh_.barycentre(t)) - wing.centre);
    return std::max(volume, 0.0);
  }

  static void setSizes(const Matrix3& variance, const Vector3& h, Wing& wing) {
    const Vector3 y = wing.facing.cross(h);
    const double along = h.dot(variance * h), swept = h.dot(variance * y);
    wing.span_axis = h;
    wing.span = std::sqrt(12 * along);
    wing.chord = std::sqrt(12 * std::max(y.dot(variance * y) - swept * swept / along, 0.0));
    if (!(wing.chord > 0)) throw std::runtime_error("a wing has no chord");
    wing.aspect = (wing.is_joined ? 2 : 1) * wing.span / wing.chord;
  }

  static Matrix3 inPlane(const Matrix3& matrix, const Vector3& z) {
    const Matrix3 onto = Matrix3::Identity() - z * z.transpose();
    return onto * matrix * onto;
  }

  /// The direction in the plane across z in which places are spread most.
  static Vector3 longestIn(const Matrix3& variance, const Vector3& z) {
    const Vector3 longest = symmetricEigen<3>(inPlane(variance, z)).vectors.col(2);
    return (longest - z.dot(longest) * z).normalized();
  }

  static void setFree(const Matrix3& variance, Wing& wing) {
    setSizes(variance, longestIn(variance, wing.facing), wing);
  }

  /// Extent of a joint along a direction.
  static double lengthOf(const std::vector<JointEdge>& joint, const Vector3& along) {
    double low = along.dot(joint.front().from), high = low;
    for (const JointEdge& edge : joint)
      for (const Vector3& end : {edge.from, edge.to}) {
        low = std::min(low, along.dot(end));
        high = std::max(high, along.dot(end));
      }
    return high - low;
  }

  /// Finds where a wing leaves the body; false if it is free.
  bool setJoint(const std::vector<JointEdge>& joint, const Matrix3& variance,
                MeasuredWing& measured) const {
    constexpr double kLeastJoint = 0.5, kLeastArm = 0.25, kLeastAcross = 0.5, kFewWithRest = 0.3;
    Wing& wing = measured.wing;
    WeightedPlaces edges;
    double with_rest = 0;
    for (const JointEdge& edge : joint) {
      const Vector3 way = edge.to - edge.from;
      edges.add(way.norm(), (edge.from + edge.to) / 2, way * way.transpose() / 12);
      if (edge.is_with_rest) with_rest += way.norm();
    }
    if (!(edges.sum > 0)) return false;
    const Vector3& z = wing.facing;
    const Vector3 off_joint = wing.centre - edges.mean();
    const Vector3 outward = off_joint - z.dot(off_joint) * z;
    Vector3 along = longestIn(edges.variance(), z);
    Vector3 h = z.cross(along);
    const bool is_arm = with_rest < kFewWithRest * edges.sum;  // that meets others in a hub
    if (is_arm && std::abs(h.dot(outward)) < kLeastAcross * outward.norm()) {
      h = outward.normalized();
      along = h.cross(z);
    }
    const double arm = h.dot(outward);
    if (arm < 0) h = -h;
    const double length = lengthOf(joint, along);
    Vector3 middle = edges.mean();  // in the mean plane, unless the wing is bent
    if (const double off = z.dot(wing.centre - middle); std::abs(off) < 2 * wing.thickness)
      middle += off * z;
    const double across = h.dot(variance * h), swept = h.dot(variance * along);
    const double chord =
        std::sqrt(12 * std::max(along.dot(variance * along) - swept * swept / across, 0.0));
    const double span = std::sqrt(12 * across);
    if (length < kLeastJoint * std::min(chord, 2 * span)) return false;
    measured.joint.rest_share = with_rest / edges.sum;
    if (!(std::abs(arm) > kLeastArm * span)) {
      if (rays_) measured.joint.step = thicknessAt(middle, {0, 0, 0}, z) / wing.thickness;
      return false;
    }
    wing.is_joined = true;
    setSizes(variance, h, wing);
    if (rays_) setBody(middle, length / 4 * along, measured);
    return true;
  }

  /// Thickness across the mean plane at places, the median [m].
  double thicknessAt(const Vector3& middle, const Vector3& aside, const Vector3& z) const {
    std::array<double, 3> found{};
    for (int i = 0; i < 3; ++i) {
      const Vector3 place = middle + (i - 1) * aside;
      found[static_cast<std::size_t>(i)] = rays_->leave(place, z) + rays_->leave(place, -z);
    }
    std::sort(found.begin(), found.end());
    return found[1];
  }

  /// Finds the body beside the joint, whose middle is given: kappa of eq. (157), and the step.
  void setBody(const Vector3& middle, const Vector3& aside, MeasuredWing& measured) const {
    Wing& wing = measured.wing;
    WingJoint& joint = measured.joint;
    const Vector3 &z = wing.facing, &h = wing.span_axis;
    constexpr double kIn = 0.05;  // of the span
    joint.root_thickness = thicknessAt(middle + kIn * wing.span * h, aside, z);
    if (!(joint.rest_share > 0.5) || !std::isfinite(joint.root_thickness)) return;
    const double beyond = thicknessAt(middle - joint.root_thickness * h, aside, z);
    joint.step = std::isfinite(beyond) ? beyond / joint.root_thickness : TriangleTree::kNever;
    std::vector<double> halves;
    for (const double degrees : {15.0, 30.0, 45.0})
      for (const double side : {1.0, -1.0})
        for (int i = -1; i <= 1; ++i) {
          const double cosine = portable::cos(degrees * kPi / 180);
          const double sine = side * std::sqrt(1 - cosine * cosine);
          halves.push_back(rays_->leave(middle + i * aside, sine * z - cosine * h) / (2 * cosine));
        }
    std::nth_element(halves.begin(), halves.begin() + 9, halves.end());
    joint.body_width = 2 * halves[9];
    const double half = std::min(halves[9], wing.span);
    wing.body_lift = 1 + half / (wing.span + half);
  }

  const TriangleMesh& mesh_;
  const TriangleTree* rays_;  ///< null: a sheet
};

}  // namespace

std::vector<MeasuredWing> measureWings(const TriangleMesh& mesh,
                                       const std::vector<std::uint8_t>& labels, bool sheet) {
  if (labels.empty()) return {};
  const std::size_t wings = *std::max_element(labels.begin(), labels.end());
  std::vector<std::vector<Eigen::Index>> triangles(wings + 1);
  for (std::size_t t = 0; t < labels.size(); ++t)
    triangles[labels[t]].push_back(static_cast<Eigen::Index>(t));
  const std::vector<std::vector<JointEdge>> joints = jointsOf(mesh, labels);
  const TriangleTree rays(mesh);
  const WingMeasure measure(mesh, sheet ? nullptr : &rays);
  std::vector<MeasuredWing> measured;
  for (std::size_t label = 1; label <= wings; ++label)
    measured.push_back(measure.of(triangles[label], joints[label]));
  return measured;
}

bool standsOff(const MeasuredWing& measured) {
  constexpr double kLeastStep = 2.5, kLeastBody = 4, kThickest = 0.25, kSlender = 1.2;
  const WingJoint& joint = measured.joint;
  const Wing& wing = measured.wing;
  if (!(wing.thickness > 0 && wing.thickness < kThinPart * wing.chord)) return false;
  if (!(joint.rest_share > 0.5)) return true;
  if (!(wing.thickness < kThickest * wing.chord)) return false;
  if (wing.is_joined && wing.span >= kSlender * wing.chord) return true;
  const bool is_beside = !wing.is_joined || joint.body_width >= kLeastBody * joint.root_thickness;
  return joint.step >= kLeastStep && std::isfinite(joint.step) && is_beside;
}

}  // namespace ambient
