#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Limits of coarsening.
struct CoarseningSettings {
  int least_faces = 0;   ///< no further than to these
  int most_faces = 0;    ///< to these whatever it costs
  double tolerance = 0;  ///< between both: as long as planes are missed by less (rms) [m]
};

/// A closed mesh of fewer triangles of about the same surface: edges are contracted, those first
/// by which it moves least (Garland and Heckbert, "Surface simplification using quadric error
/// metrics", 1997), unless a triangle would turn or become a sliver, or the surface would change
/// its topology. Flat sides and sharp edges stay in place. Cost O(T log T).
/// @pre closed and manifold.
TriangleMesh coarsened(const TriangleMesh& mesh, const CoarseningSettings& settings);

}  // namespace ambient
