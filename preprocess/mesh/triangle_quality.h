#pragma once

#include <optional>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Deviation of a triangle from an equilateral one.
struct TriangleQuality {
  int triangle = 0;
  double aspect = 0;          ///< longest edge over the height on it; 1.15 at best
  double smallest_angle = 0;  ///< [rad]
  Eigen::Vector3d barycentre = Eigen::Vector3d::Zero();  ///< [m]
};

/// Finds the triangles of largest aspect, worst first. Cost O(T log T).
std::vector<TriangleQuality> findWorstTriangles(const TriangleMesh& mesh, int count);

/// The thinnest place of a body.
struct Thickness {
  double thickness = 0;  ///< distance from a barycentre straight inwards to the other side [m]
  int triangle = 0;
  Eigen::Vector3d barycentre = Eigen::Vector3d::Zero();  ///< [m]
};

/// Finds the least thickness over the barycentres of at most some 2000 triangles, evenly chosen;
/// none if no ray meets another side. Cost O(T) per ray.
/// @pre closed and outward oriented.
std::optional<Thickness> findThinnestPart(const TriangleMesh& mesh);

}  // namespace ambient
