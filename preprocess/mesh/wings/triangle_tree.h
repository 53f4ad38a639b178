#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Rays through a mesh and its nearest triangles, by a binary tree of boxes around them.
class TriangleTree {
 public:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  /// Keeps a reference to the mesh. Cost O(T log T).
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Returns the way from a point inside along a unit vector to where the ray leaves the solid [m],
  /// or kNever. Crossings nearer than 1e-7 of the size of the mesh do not count. Cost O(log T).
  /// @pre the mesh is closed
  double leave(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;
  /// Returns the triangle nearest to a point, of several the first. @pre the mesh has triangles
  int nearest(const Eigen::Vector3d& point) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0, count = 0;  ///< of order_; count 0: two nodes follow, the second at `first`
  };

  void build(int first, int count, const Eigen::Matrix3Xd& middles);
  /// Way to a crossing outwards through a triangle, or kNever.
  double crossing(int triangle, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& direction) const;

  const TriangleMesh& mesh_;
  double least_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

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

/// The thinnest place of a body.
struct Thickness {
  double thickness = 0;  ///< distance from a barycentre straight inwards to the other side [m]
  int triangle = 0;
  Eigen::Vector3d barycentre = Eigen::Vector3d::Zero();  ///< [m]
};

/// Finds the least thickness over the barycentres of at most some 2000 triangles, evenly chosen;
/// none if no ray meets another side. Cost O(T log T).
/// @pre closed and outward oriented.
std::optional<Thickness> findThinnestPart(const TriangleMesh& mesh);

}  // namespace ambient
