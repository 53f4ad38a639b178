#include "preprocess/mesh/wings/wing_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/wings/wing_sections.h"

namespace ambient {
namespace {

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
    constexpr double kLeastJoint = 0.5, kLeastArm = 0.25;
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
    const Vector3 along = longestIn(edges.variance(), z);
    const bool is_arm = with_rest < 0.5 * edges.sum;  // of wings alone: cut anyhow
    Vector3 h = is_arm ? longestIn(variance, z) : Vector3(z.cross(along));
    const double arm = h.dot(wing.centre - edges.mean());
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

}  // namespace ambient
