#include "preprocess/resistance/separation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

/// A ball by the integrals over its meridian, U = 3/2 sin: docs/theory.md, section 18.
constexpr SeparationWay kSphere{1.89827, 0.35783, 0.48599, 1.31494,
                                0.35790, 6.58598, 0.09288, 0.36193};
/// A circle in plane flow, U = 2 sin, on its diameter.
constexpr SeparationWay kCircle{3.5955, 0.9361, 1.4368, 2.7678, 0.3154, 5.6795, 0.0968, 0.3322};

/// The flow of a motion along a unit vector.
std::vector<VertexFlow> flowAlong(const UnitFlows& flows, const Vector3d& motion) {
  std::vector<VertexFlow> flow(flows[0].size());
  for (std::size_t v = 0; v < flow.size(); ++v)
    for (std::size_t axis = 0; axis < 3; ++axis)
      flow[v].add(motion[static_cast<int>(axis)], flows[axis][v]);
  return flow;
}

/// The numbers of all ways. @param alike both ways of an axis are
MeshSeparation separationIn(const CutSurface& surface, const UnitFlows& flows, const Matrix3& axes,
                            bool alike) {
  MeshSeparation found;
  Separation& separation = found.separation;
  separation.axes = axes;
  for (int j = 0; j < 3; ++j) {
    double base = 0, smooth_base = 0;
    bool is_resolved = true;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t way = 2 * static_cast<std::size_t>(j) + side;
      if (side == 1 && alike) {
        separation.ways[way] = separation.ways[way - 1];
        found.leaves_at[way] = found.leaves_at[way - 1];
        continue;
      }
      const Vector3d motion = side == 0 ? Vector3d(axes.col(j)) : Vector3d(-axes.col(j));
      const LayerSums sums = followLayers(surface, flowAlong(flows, motion), motion);
      separation.ways[way] = sums.way;
      found.leaves_at[way] = sums.leaves_at;
      base += sums.base;
      smooth_base += sums.smooth_base;
      is_resolved = is_resolved && sums.is_resolved;
    }
    separation.smooth_base[j] = base > 0 ? smooth_base / base : 1;
    found.is_resolved = found.is_resolved && (is_resolved || separation.smooth_base[j] == 0);
  }
  return found;
}

}  // namespace

Matrix3 translationAxes(const Matrix6& added_mass) {
  Matrix3 axes = symmetricEigen<3>(Matrix3(added_mass.bottomRightCorner<3, 3>())).vectors;
  for (int j = 0; j < 2; ++j) {
    int largest = 0;
    axes.col(j).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, j) < 0) axes.col(j) *= -1;
  }
  axes.col(2) = Vector3d(axes.col(0)).cross(Vector3d(axes.col(1)));
  return axes;
}

MeshSeparation computeSeparation(const TriangleMesh& mesh,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& potential,
                                 const Matrix3& axes) {
  AMBIENT_ASSERT(potential.rows() == mesh.vertexCount());
  const CutSurface surface = cutAtSharpEdges(mesh);
  const double length = std::sqrt(areaOf(mesh) / kPi);
  return separationIn(surface, differentiateFlow(surface, potential, length), axes, false);
}

Separation ellipsoidSeparation(const Vector3& semi_axes, int faces) {
  const CutSurface surface = cutAtSharpEdges(makeEllipsoidMesh(semi_axes, faces));
  // The mesh has unit D_A: find the ellipsoid on which its vertices lie.
  const Vector3d inverse = Vector3d(semi_axes).cwiseInverse();
  const double size = inverse.cwiseProduct(Vector3d(surface.mesh.vertices.col(0))).norm();
  const Matrix6 added_mass = ellipsoidAddedMass(semi_axes).asDiagonal();
  return separationIn(surface, ellipsoidFlow(surface, size * Vector3d(semi_axes)),
                      translationAxes(added_mass), true)
      .separation;
}

Separation sphereSeparation() {
  Separation separation;
  separation.ways.fill(kSphere);
  separation.smooth_base = {1, 1, 1};
  return separation;
}

Separation cylinderSeparation(double radius, double height, const Matrix3& axes) {
  AMBIENT_ASSERT(radius > 0 && height > 0);
  const double q = 2 * radius / std::sqrt(2 * radius * (radius + height));  // D over D_A
  SeparationWay way = kCircle;
  way.thickness *= std::sqrt(q);
  way.friction_laminar /= std::sqrt(q);
  const double root = portable::pow(q, -0.2);
  way.friction_bubble *= root;
  way.friction_turbulent *= root;
  Separation separation;
  separation.axes = axes;
  separation.ways.fill(way);
  for (int j = 0; j < 3; ++j)
    separation.smooth_base[j] = std::abs(axes(2, j)) > 0.5 ? 0 : height / (height + radius);
  return separation;
}

}  // namespace ambient
