#pragma once

#include <Eigen/Core>
#include <vector>

#include "preprocess/mesh/holds/pools.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

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
