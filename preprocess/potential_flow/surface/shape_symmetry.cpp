#include "preprocess/potential_flow/surface/shape_symmetry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/base/numerics.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMirrorTolerance = 1e-7;  // of the size, and of normals

/// The edges at which the surface bends, with the normal of the triangle on their left.
class BentEdges {
 public:
  BentEdges(const TriangleMesh& mesh, const Vector3d& centre) {
    const MeshEdges edges = computeMeshEdges(mesh);
    for (const EdgeGroup& edge : edges.edges) {
      const HalfEdge* side = &edges.half_edges[edge.first];
      const bool bent =
          edge.size() != 2 ||
          normalOf(mesh, side[0].triangle).cross(normalOf(mesh, side[1].triangle)).norm() >
              kMirrorTolerance;
      for (std::size_t k = 0; bent && k < edge.size(); ++k) add(mesh, side[k]);
    }
    placeVertices(mesh, centre);
  }

  bool isKeptBy(const Matrix3d& turn) const {
    const bool mirrors = turn.determinant() < 0;
    std::map<int, int> image;
    for (const auto& [vertex, place] : places_) {
      const int found = vertexAt(turn * place);
      if (found < 0) return false;
      image[vertex] = found;
    }
    return std::all_of(normals_.begin(), normals_.end(), [&](const auto& edge) {
      std::pair<int, int> ends(image[edge.first.first], image[edge.first.second]);
      if (mirrors) std::swap(ends.first, ends.second);
      const auto found = normals_.find(ends);
      return found != normals_.end() &&
             (found->second - turn * edge.second).norm() < kMirrorTolerance;
    });
  }

 private:
  void add(const TriangleMesh& mesh, const HalfEdge& side) {
    const int from = side.forward ? side.low : side.high;
    const int to = side.forward ? side.high : side.low;
    normals_[{from, to}] = normalOf(mesh, side.triangle);
  }

  void placeVertices(const TriangleMesh& mesh, const Vector3d& centre) {
    for (const auto& [ends, normal] : normals_) {
      const Vector3d place = mesh.vertices.col(ends.first) - centre;
      places_[ends.first] = place;
      size_ = std::max(size_, place.norm());
    }
    for (const auto& [vertex, place] : places_) along_.emplace_back(place.dot(direction_), vertex);
    std::sort(along_.begin(), along_.end());
  }

  /// The vertex at a place; -1: none.
  int vertexAt(const Vector3d& place) const {
    const double reach = kMirrorTolerance * size_, along = place.dot(direction_);
    auto candidate =
        std::lower_bound(along_.begin(), along_.end(), std::pair<double, int>(along - reach, -1));
    for (; candidate != along_.end() && candidate->first <= along + reach; ++candidate)
      if ((places_.at(candidate->second) - place).norm() <= reach) return candidate->second;
    return -1;
  }

  std::map<std::pair<int, int>, Vector3d> normals_;  ///< by the two ends
  std::map<int, Vector3d> places_;                   ///< of the vertices, from the centre
  std::vector<std::pair<double, int>> along_;        ///< the vertices, along a direction
  double size_ = 0;
  const Vector3d direction_ = Vector3d(0.5772, 0.6931, 0.4319).normalized();  // along no symmetry
};

/// Principal axes of its vertices, then axes of the mesh: what these forbid is zero to the last
/// bit, and a turn about others would round it again.
std::vector<Matrix3d> candidateAxes(const TriangleMesh& mesh, const Vector3d& centre) {
  const Eigen::Matrix3Xd offsets = mesh.vertices.colwise() - centre;
  return {symmetricEigen<3>(offsets * offsets.transpose()).vectors, Matrix3d::Identity()};
}

}  // namespace

std::vector<Matrix3d> findSymmetries(const TriangleMesh& mesh, const Vector3d& centre) {
  const BentEdges edges(mesh, centre);
  std::vector<Matrix3d> symmetries;
  for (const Matrix3d& axes : candidateAxes(mesh, centre))
    for (int axis = 0; axis < 3; ++axis) {
      const Matrix3d mirror =
          Matrix3d::Identity() - 2 * axes.col(axis) * axes.col(axis).transpose();
      for (const Matrix3d& turn : {mirror, Matrix3d(-mirror)})
        if (edges.isKeptBy(turn)) symmetries.push_back(turn);
    }
  return symmetries;
}

Matrix6 turned(const Matrix6& inertia, const Matrix3d& turn) {
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = turn.determinant() * turn;  // a rotation is an axial vector
  both.bottomRightCorner<3, 3>() = turn;
  return both * inertia * both.transpose();
}

Matrix6 symmetrised(Matrix6 inertia, const std::vector<Matrix3d>& symmetries) {
  for (const Matrix3d& turn : symmetries) inertia = (inertia + turned(inertia, turn)) / 2;
  return inertia;
}

Matrix6 withSymmetriesOf(const TriangleMesh& mesh, bool sheet, const Matrix6& matrix,
                         Rescaling rescaled, double stretch) {
  const MeshProperties properties = computeMassProperties(mesh, sheet);
  const Vector3d& centre = properties.uniform.centre;
  const double size = std::sqrt(properties.area);
  AMBIENT_ASSERT(properties.area > 0 && stretch > 0);
  Matrix6 unit = rescaled(shiftOrigin(matrix, centre), stretch / size);
  unit = positivePart(symmetrised(unit, findSymmetries(mesh, centre)));
  AMBIENT_ASSERT(isSymmetric(unit, 1e-9));
  return symmetricPart(shiftOrigin(rescaled(unit, size), -centre));  // rounds its halves apart
}

Matrix6 symmetrisedAddedMass(const Matrix6& added_mass, const TriangleMesh& mesh) {
  const Vector3d centre = computeMassProperties(mesh).uniform.centre;
  const Matrix6 about_centre =
      symmetrised(shiftOrigin(added_mass, centre), findSymmetries(mesh, centre));
  return symmetricPart(shiftOrigin(about_centre, -centre));
}

}  // namespace ambient
