#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A flat convex polygon, counter-clockwise seen from where its normal points to.
struct FlatPolygon {
  std::vector<Eigen::Vector3d> corners;  ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// Converts the triangles of a mesh to polygons; leaves out triangles without a normal.
std::vector<FlatPolygon> polygonsOf(const TriangleMesh& mesh);

/// The inside of a closed mesh as a tree of half spaces: Naylor, Amanatides, Thibault, "Merging BSP
/// trees yields polyhedral set operations", 1990. For a convex mesh of n planes a chain of n nodes.
class BspTree {
 public:
  static constexpr std::size_t kMostPlanes = 8000;

  /// Points closer to a plane than the tolerance [m] lie on it.
  /// @pre closed and outward oriented.
  /// @throws std::runtime_error if it takes more than kMostPlanes.
  BspTree(const TriangleMesh& mesh, double tolerance);

  /// Returns the pieces of a polygon of another solid's surface that are on the surface of the
  /// union of both; the polygon itself if nothing has to be removed. Pieces on the surface of this
  /// solid are removed where the two solids touch from outside. Where both surfaces are flush they
  /// stay if `keep_coplanar`, which exactly one of the two solids should have. Cost: the number of
  /// planes that the polygon meets.
  std::vector<FlatPolygon> clip(const FlatPolygon& polygon, bool keep_coplanar) const;

 private:
  struct Node {
    Eigen::Vector3d normal;
    double offset = 0;
    int front = kOutside, back = kInside;  // nodes
  };
  static constexpr int kOutside = -1, kInside = -2;
  struct Sides {
    FlatPolygon front, back;  // without corners: nothing there
    bool is_flat = false;     // in the plane
  };

  Sides divide(const Node& node, const FlatPolygon& polygon) const;
  void divide(int node, const FlatPolygon& polygon, std::vector<FlatPolygon>& outside,
              std::vector<FlatPolygon>& inside, bool keep_coplanar) const;

  /// Returns the pieces of a polygon around the part of it that is inside a convex solid, cut by
  /// those planes alone that the part ends at.
  std::vector<FlatPolygon> piecesAround(const FlatPolygon& hole, const FlatPolygon& polygon) const;

  double tolerance_;
  std::vector<Node> nodes_;
  bool is_convex_ = true;
};

}  // namespace ambient
