#pragma once

#include <array>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Directions spread over the sphere: the 4 n^2 + 2 points with integer coordinates on the
/// octahedron |x| + |y| + |z| = n, seen from its centre. The lattice is symmetric in all axes.
class OctahedralLattice {
 public:
  /// `subdivisions` n: intervals per edge of the octahedron. @pre subdivisions > 0
  explicit OctahedralLattice(int subdivisions) : n_(subdivisions) {}

  int size() const { return 4 * n_ * n_ + 2; }
  /// Unit vector towards a node. @pre 0 <= node < size()
  Vector3 direction(int node) const noexcept;

  /// Corners of the lattice triangle that a direction meets, and their interpolation weights
  /// (`weight`, sum 1). Weights are continuous in the direction and linear on the octahedron.
  struct Corners {
    std::array<int, 3> node;
    std::array<double, 3> weight;
  };
  /// Locates a direction of any length. @pre the direction is not 0
  Corners cornersAround(const Vector3& direction) const noexcept;

 private:
  /// Number of nodes with a larger z.
  int nodesAbove(int z) const noexcept;
  int nodeOf(int x, int y, int z) const noexcept;

  int n_;
};

}  // namespace ambient
