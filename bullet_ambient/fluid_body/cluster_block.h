#pragma once

namespace ambient {

/// Sixteen clusters of faces, component by component: input of the kernels of reduced loads. Plain
/// data only, like FaceBlock. Unit of length: LoadLevel::length; origin: LoadLevel::centre.
/// docs/theory.md eq. (36) to (39).
struct alignas(64) ClusterBlock {
  static constexpr int kClusters = 16;
  static constexpr int kRows = 34;
  float switching[6][kClusters];  ///< g: mean of (c x n, n)
  float spread[2][6][kClusters];  ///< j_1, j_2: two largest principal deviations of (c x n, n)
  float centroid[3][kClusters];   ///< mean of c
  float area[kClusters];          ///< sum over the faces
  float by_slip[6][kClusters];    ///< h_A: wrench per |t|^2
  float by_normal[6][kClusters];  ///< h_B: wrench per mean of (n.u)^2
};
static_assert(sizeof(ClusterBlock) == sizeof(float) * ClusterBlock::kRows * ClusterBlock::kClusters,
              "files hold blocks as plain numbers");

}  // namespace ambient
