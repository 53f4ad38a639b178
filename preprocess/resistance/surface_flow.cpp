#include "preprocess/resistance/surface_flow.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSharpCosineOfEdges = 0.64278761;  // cos 50 degrees, as in eq. (45c)

/// Whether the surface is convex at an edge and its normals differ by more than 50 degrees.
bool isSharp(const TriangleMesh& mesh, const EdgePair& edge) {
  const Vector3d normal = mesh.twiceArea(edge.first.triangle).normalized();
  const Vector3d other = mesh.twiceArea(edge.second.triangle).normalized();
  const Vector3d across = mesh.corner(edge.second.triangle, (edge.second.side + 2) % 3) -
                          mesh.vertices.col(edge.first.low);
  return across.dot(normal) < 0 && normal.dot(other) < kSharpCosineOfEdges;
}

/// Number of a vertex for each corner of the triangles (3 t + k): corners that hang together around
/// a vertex without crossing a sharp edge have one number.
std::vector<int> cornerVertices(const TriangleMesh& mesh, std::vector<int>& source) {
  DisjointSets corners(3 * static_cast<std::size_t>(mesh.triangleCount()));
  for (const EdgePair& edge : edgePairs(computeMeshEdges(mesh)))
    if (!isSharp(mesh, edge)) joinCorners(corners, mesh, edge);
  std::vector<int> of_corner = corners.numbers();
  for (std::size_t c = 0; c < of_corner.size(); ++c)
    if (of_corner[c] == static_cast<int>(source.size()))
      source.push_back(mesh.triangles(static_cast<Index>(c % 3), static_cast<Index>(c / 3)));
  return of_corner;
}

/// Vertices of the cut surface that were one vertex.
std::vector<std::vector<int>> copiesOf(const std::vector<int>& source) {
  std::map<int, std::vector<int>> at;
  for (std::size_t v = 0; v < source.size(); ++v) at[source[v]].push_back(static_cast<int>(v));
  std::vector<std::vector<int>> copies(source.size());
  for (const auto& [vertex, all] : at)
    for (const int v : all)
      for (const int other : all)
        if (other != v) copies[v].push_back(other);
  return copies;
}

/// Normal at a vertex, exact on a sphere (Max 1999).
Vector3d normalAt(const TriangleMesh& mesh, const std::vector<int>& fan, int vertex) {
  Vector3d sum = Vector3d::Zero();
  for (const int t : fan)
    for (int k = 0; k < 3; ++k) {
      if (mesh.triangles(k, t) != vertex) continue;
      const Vector3d p = mesh.corner(t, k), a = mesh.corner(t, (k + 1) % 3) - p,
                     b = mesh.corner(t, (k + 2) % 3) - p;
      sum += a.cross(b) / (a.squaredNorm() * b.squaredNorm());
    }
  return sum.normalized();
}

/// The vertex and its neighbours over two rings of triangles.
std::vector<int> neighboursOf(const CutSurface& surface, int vertex) {
  std::vector<int> found{vertex};
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<int> inner = found;
    for (const int v : inner)
      for (const int t : surface.fans[v])
        for (int k = 0; k < 3; ++k) found.push_back(surface.mesh.triangles(k, t));
    std::sort(found.begin() + 1, found.end());
    found.erase(std::unique(found.begin() + 1, found.end()), found.end());
    found.erase(std::remove(found.begin() + 1, found.end(), vertex), found.end());
  }
  return found;
}

constexpr int kLinear = 3, kQuadratic = 6, kCubic = 10;  // coefficients

/// A fit of polynomials in the plane of the normal at a vertex.
class SurfaceFit {
 public:
  SurfaceFit(const CutSurface& surface, int vertex) : at_(neighboursOf(surface, vertex)) {
    const Vector3d n = surface.normals[vertex], x = n.unitOrthogonal(),
                   p = surface.mesh.vertices.col(vertex);
    basis_ << x, n.cross(x);
    const auto count = static_cast<Index>(at_.size());
    Eigen::Matrix2Xd places(2, count);
    for (Index i = 0; i < count; ++i)
      places.col(i) = basis_.transpose() * (Vector3d(surface.mesh.vertices.col(at_[i])) - p);
    size_ = std::sqrt(places.squaredNorm() / static_cast<double>(count));
    places /= size_;
    distances_ = places.colwise().norm();
    const bool is_cut = !surface.copies[vertex].empty();
    constexpr Index kEnoughForCubic = 15, kEnoughForQuadratic = 8;
    terms_ = count >= kEnoughForCubic && !is_cut ? kCubic
             : count >= kEnoughForQuadratic      ? kQuadratic
                                                 : kLinear;
    weights_ = (1 / (0.3 + distances_.array())).matrix();
    Eigen::MatrixXd rows(count, terms_);
    for (Index i = 0; i < count; ++i)
      rows.row(i) = weights_[i] * monomials(places(0, i), places(1, i)).head(terms_);
    solver_.compute(rows);
  }

  /// Derivatives of a function of the vertices at the vertex. They are limited by its differences
  /// to the neighbours: where these lie nearly in line, as between slivers, what a fit says across
  /// the line is noise.
  template <class ValueAt>
  VertexFlow derivatives(const ValueAt& value_at) const {
    Eigen::VectorXd values(static_cast<Index>(at_.size()));
    const double here = value_at(at_.front());
    constexpr double kNearest = 0.1;  // closer, differences are noise
    double steepest = 0;
    for (Index i = 0; i < values.size(); ++i) {
      const double change = value_at(at_[i]) - here;
      values[i] = weights_[i] * change;
      steepest = std::max(steepest, std::abs(change) / std::max(distances_[i], kNearest));
    }
    constexpr double kMostSlope = 2, kMostBend = 8;  // of a smooth function at most 1.2 and 2 or so
    Eigen::VectorXd c = solver_.solve(values);
    c.segment<2>(1) *= shareWithin(kMostSlope * steepest, c.segment<2>(1).norm());
    VertexFlow flow;
    flow.potential = here;
    flow.velocity = basis_ * c.segment<2>(1) / size_;
    if (terms_ == kLinear) return flow;
    Eigen::Matrix2d second;
    second << 2 * c[3], c[4], c[4], 2 * c[5];
    second *= shareWithin(kMostBend * steepest, second.norm());
    flow.stretching = basis_ * (second / (size_ * size_)) * basis_.transpose();
    return flow;
  }

 private:
  static Eigen::Matrix<double, 1, kCubic> monomials(double x, double y) {
    Eigen::Matrix<double, 1, kCubic> m;
    m << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
    return m;
  }

  /// What leaves of a size at most a limit.
  static double shareWithin(double most, double size) { return size > most ? most / size : 1; }

  std::vector<int> at_;
  Eigen::Matrix<double, 3, 2> basis_;
  Eigen::VectorXd distances_, weights_;  ///< distances in units of size_
  double size_ = 0;
  int terms_ = 0;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver_;
};

}  // namespace

VertexFlow& VertexFlow::add(double factor, const VertexFlow& other) {
  potential += factor * other.potential;
  velocity += factor * other.velocity;
  stretching += factor * other.stretching;
  return *this;
}

CutSurface cutAtSharpEdges(const TriangleMesh& mesh) {
  CutSurface surface;
  const std::vector<int> of_corner = cornerVertices(mesh, surface.source);
  const double length = std::sqrt(areaOf(mesh) / kPi);
  surface.mesh.vertices.resize(3, static_cast<Index>(surface.source.size()));
  for (std::size_t v = 0; v < surface.source.size(); ++v)
    surface.mesh.vertices.col(static_cast<Index>(v)) =
        mesh.vertices.col(surface.source[v]) / length;
  surface.mesh.triangles.resize(3, mesh.triangleCount());
  surface.fans.resize(surface.source.size());
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) {
      surface.mesh.triangles(k, t) = of_corner[static_cast<std::size_t>(3 * t + k)];
      surface.fans[static_cast<std::size_t>(surface.mesh.triangles(k, t))].push_back(
          static_cast<int>(t));
    }
    const Vector3d twice = surface.mesh.twiceArea(t);
    surface.area.push_back(twice.norm() / 2);
    surface.triangle_normals.push_back(twice.normalized());
  }
  surface.copies = copiesOf(surface.source);
  for (std::size_t v = 0; v < surface.source.size(); ++v)
    surface.normals.push_back(normalAt(surface.mesh, surface.fans[v], static_cast<int>(v)));
  return surface;
}

UnitFlows differentiateFlow(const CutSurface& surface,
                            const Eigen::Matrix<double, Eigen::Dynamic, 3>& potential,
                            double length) {
  AMBIENT_ASSERT(length > 0);
  UnitFlows flows;
  for (int v = 0; v < static_cast<int>(surface.source.size()); ++v) {
    const SurfaceFit fit(surface, v);
    // The body moves along an axis: past it the fluid comes from there.
    for (int axis = 0; axis < 3; ++axis)
      flows[axis].push_back(fit.derivatives([&](int i) {
        return potential(surface.source[i], axis) / length - surface.mesh.vertices(axis, i);
      }));
  }
  return flows;
}

UnitFlows ellipsoidFlow(const CutSurface& surface, const Eigen::Vector3d& semi_axes) {
  const Vector3d added = ellipsoidAddedMass(semi_axes).tail<3>() / (4 * kPi / 3 * semi_axes.prod());
  const Vector3d inverse = semi_axes.cwiseAbs2().cwiseInverse();
  UnitFlows flows;
  for (Index v = 0; v < surface.mesh.vertexCount(); ++v) {
    const Vector3d p = surface.mesh.vertices.col(v), slope = inverse.cwiseProduct(p),
                   n = slope.normalized();
    const Matrix3d along = Matrix3d::Identity() - n * n.transpose();
    const Matrix3d bend = along * inverse.asDiagonal() * along / slope.norm();  // dn/dx
    for (int axis = 0; axis < 3; ++axis) {
      const double factor = -(1 + added[axis]);
      VertexFlow flow;
      flow.potential = factor * p[axis];
      flow.velocity = factor * along.col(axis);
      flow.stretching = -factor * n[axis] * bend;
      flows[axis].push_back(flow);
    }
  }
  return flows;
}

}  // namespace ambient
