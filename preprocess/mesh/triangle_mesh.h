#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ambient {

/// Indexed triangle mesh. Triangles are counter-clockwise seen from the fluid: (b - a) x (c - a)
/// points into it.
struct TriangleMesh {
  Eigen::Matrix3Xd vertices;   ///< 3 x V [m]
  Eigen::Matrix3Xi triangles;  ///< 3 x T vertex indices

  Eigen::Index vertexCount() const { return vertices.cols(); }
  Eigen::Index triangleCount() const { return triangles.cols(); }
  Eigen::Vector3d corner(Eigen::Index triangle, int k) const {
    return vertices.col(triangles(k, triangle));
  }
  Eigen::Vector3d barycentre(Eigen::Index triangle) const {
    return (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3;
  }
  /// Normal of a triangle times twice its area [m^2].
  Eigen::Vector3d twiceArea(Eigen::Index triangle) const {
    const Eigen::Vector3d a = corner(triangle, 0);
    return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a);
  }
  /// Bounding box along the axes [m]. @pre there are vertices.
  Eigen::AlignedBox3d bounds() const {
    return {vertices.rowwise().minCoeff(), vertices.rowwise().maxCoeff()};
  }
  /// Sizes of the bounding box along the axes [m]. @pre there are vertices.
  Eigen::Vector3d extents() const {
    return vertices.rowwise().maxCoeff() - vertices.rowwise().minCoeff();
  }
};

}  // namespace ambient
