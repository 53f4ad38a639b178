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

/// A mesh whose holds end level, where their pools would spill.
struct LevelRims {
  TriangleMesh mesh;        ///< the same surface; triangles are divided at the levels
  std::vector<int> labels;  ///< of its triangles: 0 outside, 1 and up the holds
};

/// Divides the triangles of a mesh just below the height at which each pool spills, or meets the
/// other, within 0.5 % of its depth, and labels those around it below that height: their border is
/// a level line, and a lid across it cuts nothing but what stands in the pool. A hold loses what
/// lies above the lowest place of its rim.
/// @param mesh closed, manifold and outward
/// @param up unit vector, that of the pools
LevelRims levelRims(TriangleMesh mesh, const Eigen::Vector3d& up, const std::vector<Pool>& pools);

}  // namespace ambient
