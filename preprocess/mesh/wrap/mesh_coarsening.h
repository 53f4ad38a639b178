#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Limits of coarsening.
struct CoarseningSettings {
  int least_faces = 0;  ///< coarsening stops at this number of triangles
  int most_faces = 0;   ///< coarsening goes on to this number, whatever the error
  double tolerance =
      0;  ///< between both numbers: limit of the rms distance from the original planes [m]
};

/// Reduces the triangles of a closed mesh with about the same surface: contracts edges, first those
/// that move the surface least (Garland and Heckbert, "Surface simplification using quadric error
/// metrics", 1997), unless a triangle would turn or become a sliver, or the surface would change
/// its topology. Flat sides and sharp edges stay in place. Cost O(T log T).
/// @pre closed and manifold.
TriangleMesh coarsened(const TriangleMesh& mesh, const CoarseningSettings& settings);

}  // namespace ambient
