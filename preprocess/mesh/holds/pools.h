#pragma once

#include <Eigen/Core>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Vertices at which rain would stand on a mesh, up to where it spills or meets another pool.
struct Pool {
  std::vector<int> vertices;
  int lowest = 0;     ///< the lowest of them
  double depth = 0;   ///< from there to where it spills or meets the other [m]
  double volume = 0;  ///< below that height [m^3]
};

/// Finds the pools of a closed mesh by the join tree of its height along `up`, docs/theory.md
/// section 20: the surface below a height falls into parts that hang together, each of which
/// encloses, with its level cap, solid (positive volume) or a pool (negative volume). A pool spills
/// at the vertex where it meets a part whose cap is larger than its own: the outside. Where it
/// meets a smaller one, an island stands in it; where it meets another pool, a bulkhead stands
/// between them. Such pools remain apart if the bulkhead reaches 80 % of the depth to the spill and
/// each has 5 % of the whole. Pools below 1 % of the bounding box do not count. Cost O(T log T),
/// and for each vertex at which parts meet the triangles that its level cuts.
/// @param mesh closed, manifold and outward
/// @param up unit vector
std::vector<Pool> findPools(const TriangleMesh& mesh, const Eigen::Vector3d& up);

}  // namespace ambient
