#pragma once

namespace ambient {

/// Sixteen clusters of faces, component by component: what the kernels of reduced loads read. Plain
/// data only, as FaceBlock. Lengths and areas in units of the level's length; points from its
/// centre. docs/theory.md eq. (36) to (39).
struct alignas(64) ClusterBlock {
  static constexpr int kClusters = 16;
  static constexpr int kRows = 34;
  float switching[6][kClusters];  ///< g: mean of (c x n, n)
  float spread[2][6][kClusters];  ///< j_1, j_2: its two largest principal deviations
  float centroid[3][kClusters];   ///< mean of c
  float area[kClusters];          ///< sum of the faces
  float by_slip[6][kClusters];    ///< h_A: wrench per |t|^2
  float by_normal[6][kClusters];  ///< h_B: wrench per mean of (n.u)^2
};
static_assert(sizeof(ClusterBlock) == sizeof(float) * ClusterBlock::kRows * ClusterBlock::kClusters,
              "files hold blocks as plain numbers");

}  // namespace ambient
