#pragma once

#include <cstdint>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wings/triangle_tree.h"

namespace ambient {

constexpr double kThinPart = 0.3;  ///< thickness over chord of a wing, at most

/// Point of a closed surface, and the solid behind it.
struct SurfaceSample {
  Eigen::Vector3d place, normal;  ///< normal into the fluid
  Eigen::Vector3d middle;         ///< half way through the solid: on its mean surface
  int triangle = 0;
  double thickness = 0;  ///< way through the solid against the normal [m]
  bool is_thin = false;  ///< thickness below 0.3 of the shortest way across it
};

/// Points spread evenly over a closed surface.
struct SurfaceSamples {
  std::vector<SurfaceSample> all;
  double spacing = 0;  ///< root of the area of each [m]
};

/// Spreads points over the area, the same in every call. Cost: `count` times seven lines through
/// the solid.
SurfaceSamples sampleSurface(const TriangleMesh& mesh, const TriangleTree& tree, int count);

/// Random numbers, the same on every machine.
class SampleNumbers {
 public:
  explicit SampleNumbers(std::uint64_t seed) : state_(seed) {}
  /// Returns the next one, in [0, 1).
  double next() {
    state_ += 0x9e3779b97f4a7c15u;  // splitmix64
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace ambient
