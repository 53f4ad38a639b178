#pragma once

#include <Eigen/Core>
#include <vector>

#include "preprocess/mesh/holds/pools.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Neighbours of the triangles of a closed mesh.
class TriangleNeighbours {
 public:
  explicit TriangleNeighbours(const TriangleMesh& mesh);

  /// The triangle across the side from corner k to the next one, and its side there.
  struct Side {
    int triangle = 0, side = 0;
  };
  Side across(int triangle, int side) const { return sides_[3 * triangle + side]; }

 private:
  std::vector<Side> sides_;
};

/// To whom the triangles of a mesh belong: 0 outside, 1 and up the holds, in the order of the
/// pools.
/// @param is_tilted pools may be parts of one hold: those whose faces meet are one
std::vector<int> labelTriangles(const TriangleMesh& mesh, const TriangleNeighbours& neighbours,
                                const Eigen::Vector3d& up, const std::vector<Pool>& pools,
                                bool is_tilted);

}  // namespace ambient
