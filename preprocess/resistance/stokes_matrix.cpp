#include "preprocess/resistance/stokes_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/potential_flow/surface/panel_views.h"
#include "preprocess/potential_flow/surface/quadrature_rules.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Limits of the distance of centroids over the sum of the radii.
constexpr double kTouching = 1.1816;  // 2/3 sqrt(pi): up to here sixteen points
constexpr double kNear = 3;           // six points
constexpr double kFar = 8;  // three points, beyond one; kNear for groups of several panels

/// Exact to degree 2.
constexpr std::array<TriangleNode, 3> kTriangleRule3{{{{2.0 / 3, 1.0 / 6, 1.0 / 6}, 1.0 / 3},
                                                      {{1.0 / 6, 2.0 / 3, 1.0 / 6}, 1.0 / 3},
                                                      {{1.0 / 6, 1.0 / 6, 2.0 / 3}, 1.0 / 3}}};

/// Panels with one force per area, and their extent.
struct Group {
  std::vector<std::size_t> members;
  Vector3d centroid = Vector3d::Zero();
  double area = 0, radius = 0;
};

template <class Place>
bool isWithin(double limit, const Panel& a, const Place& b) {
  const double reach = limit * (a.radius + b.radius);
  return (a.centroid - b.centroid).squaredNorm() < reach * reach;
}

std::vector<Group> groupsOf(const std::vector<Panel>& panels, const std::vector<int>& group,
                            int count) {
  std::vector<Group> groups(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < panels.size(); ++t) {
    AMBIENT_ASSERT(group[t] >= 0 && group[t] < count);
    Group& of_panel = groups[static_cast<std::size_t>(group[t])];
    of_panel.members.push_back(t);
    of_panel.area += panels[t].area;
    of_panel.centroid += panels[t].area * panels[t].centroid;
  }
  for (Group& g : groups) {
    g.centroid /= g.area;
    for (const std::size_t t : g.members)
      g.radius = std::max(g.radius, (panels[t].centroid - g.centroid).norm() + panels[t].radius);
  }
  return groups;
}

/// Points that see one panel, at most sixteen, and the groups that their tensors count for.
class PointBlock {
 public:
  PointBlock(const Panel& source, std::vector<Matrix3d>& rows) : source_(source), rows_(rows) {}

  /// Adds a point of a group with its weight, and evaluates a full block.
  void add(std::size_t group, const Vector3d& point, double weight) {
    points_[count_] = point;
    group_[count_] = group;
    weight_[count_] = weight;
    if (++count_ == kMostPanelPoints) flush();
  }

  /// Adds the points of a rule on a panel of a group.
  template <std::size_t N>
  void add(std::size_t group, const Panel& panel, const std::array<TriangleNode, N>& rule) {
    for (const TriangleNode& node : rule)
      add(group, panel.at(node.barycentric), panel.area * node.weight);
  }

  /// Evaluates what is left.
  void flush() {
    if (count_ == 0) return;
    std::array<Matrix3d, kMostPanelPoints> tensors;
    computeStokeslets(source_, points_.data(), count_, tensors.data());
    for (std::size_t i = 0; i < count_; ++i) rows_[group_[i]] += weight_[i] * tensors[i];
    count_ = 0;
  }

 private:
  const Panel& source_;
  std::vector<Matrix3d>& rows_;
  std::array<Vector3d, kMostPanelPoints> points_;
  std::array<std::size_t, kMostPanelPoints> group_{};
  std::array<double, kMostPanelPoints> weight_{};
  std::size_t count_ = 0;
};

/// Whether the integral of a pair has its points on the first group and the closed form on the
/// second one: on the smaller one if they differ clearly, so that rounding does not decide.
bool hasPoints(std::size_t first, std::size_t second, const std::vector<Group>& groups) {
  constexpr double kClearlySmaller = 0.7937;
  const double a = groups[first].radius, b = groups[second].radius;
  if (a < kClearlySmaller * b || b < kClearlySmaller * a) return a < b;
  return first <= second;
}

/// Adds int_G int_S of the groups G that have points and one panel S of a group.
void addIntegrals(const Panel& source, std::size_t of, const std::vector<Panel>& panels,
                  const std::vector<Group>& groups, std::vector<Matrix3d>& rows) {
  PointBlock block(source, rows);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!hasPoints(g, of, groups)) continue;
    const double far = groups[g].members.size() > 1 ? kNear : kFar;
    if (!isWithin(far, source, groups[g])) {
      block.add(g, groups[g].centroid, groups[g].area);
      continue;
    }
    for (const std::size_t t : groups[g].members) {
      const Panel& panel = panels[t];
      if (isWithin(kTouching, source, panel))
        block.add(g, panel, kTriangleRule16);
      else if (isWithin(kNear, source, panel))
        block.add(g, panel, kTriangleRule6);
      else if (isWithin(far, source, panel))
        block.add(g, panel, kTriangleRule3);
      else
        block.add(g, panel.centroid, panel.area);
    }
  }
  block.flush();
}

}  // namespace

void computeStokeslets(const Panel& panel, const Vector3d* points, std::size_t count,
                       Matrix3d* tensors) {
  const PanelViews views = viewPanel(panel, points, count);
  const Vector3d& n = panel.normal;
  for (std::size_t i = 0; i < count; ++i) {
    const double height = views.height[i];
    const double lid = height * views.solid_angle[i];  // |h| Omega: both change sign with the side
    std::array<double, 3> distance;                    // R of the corners
    for (int k = 0; k < 3; ++k) distance[k] = (panel.corner[k] - points[i]).norm();
    Matrix3d edges = Matrix3d::Zero();
    Vector3d q = Vector3d::Zero();
    double potential = -lid;
    for (int k = 0; k < 3; ++k) {
      const Vector3d& m = panel.edge_normal[k];
      const double f = views.edge_potential[k][i], along = views.edge_distance[k][i] * f;
      const double change = (distance[(k + 1) % 3] - distance[k]) / panel.edge_length[k];
      potential += along;
      edges += (along * m + change * panel.edge[k]) * m.transpose();
      q += f * m;
    }
    const Matrix3d bent = n * (height * q).transpose();
    const Matrix3d tensor = potential * (2 * Matrix3d::Identity() - n * n.transpose()) +
                            lid * n * n.transpose() + bent + bent.transpose() - edges;
    tensors[i] = (tensor + tensor.transpose()) / 2;
  }
}

Eigen::MatrixXd assembleStokesMatrix(const std::vector<Panel>& panels,
                                     const std::vector<int>& group, int count, int threads) {
  AMBIENT_ASSERT(group.size() == panels.size() && count > 0);
  const std::vector<Group> groups = groupsOf(panels, group, count);
  const Index size = 3 * static_cast<Index>(count);
  Eigen::MatrixXd A(size, size);
  parallelFor(threads, count, [&](std::ptrdiff_t column) {
    const auto of = static_cast<std::size_t>(column);
    std::vector<Matrix3d> rows(groups.size(), Matrix3d::Zero());
    for (const std::size_t s : groups[of].members)
      addIntegrals(panels[s], of, panels, groups, rows);
    rows[of] /= 2;
    for (std::size_t g = 0; g < rows.size(); ++g)
      A.block<3, 3>(3 * static_cast<Index>(g), 3 * column) = rows[g];
  });
  for (Index j = 0; j < size; ++j)
    for (Index i = 0; i <= j; ++i) A(i, j) = A(j, i) = A(i, j) + A(j, i);
  return A;
}

}  // namespace ambient
