#pragma once

#include <array>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Directions spread over the sphere: the points with whole coordinates of the octahedron |x| + |y|
/// + |z| = n, 4 n^2 + 2 of them, seen from its centre. They are symmetric in all axes.
class OctahedralLattice {
 public:
  /// @pre subdivisions of an edge of the octahedron are positive
  explicit OctahedralLattice(int subdivisions) : n_(subdivisions) {}

  int size() const { return 4 * n_ * n_ + 2; }
  /// Unit vector. @pre 0 <= node < size()
  Vector3 direction(int node) const noexcept;

  /// The corners of the triangle of the lattice that a direction meets, and the share of each:
  /// continuous, and linear on the octahedron.
  struct Place {
    std::array<int, 3> node;
    std::array<double, 3> share;
  };
  /// @pre the direction is not 0
  Place placeOf(const Vector3& direction) const noexcept;

 private:
  /// Nodes with a larger z than that.
  int nodesAbove(int z) const noexcept;
  int nodeOf(int x, int y, int z) const noexcept;

  int n_;
};

}  // namespace ambient
