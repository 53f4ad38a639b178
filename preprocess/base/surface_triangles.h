#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Cosine of 41 degrees: a larger angle between the normals of two faces is an edge.
constexpr double kEdgeCosine = 0.75470958;

/// Triangles of a fluid body's surface; corners with equal coordinates share one vertex.
class SurfaceTriangles {
 public:
  /// Takes normals from the faces. @throws std::invalid_argument in one sentence, if the number of
  /// faces is neither that of the triangles nor twice that number (a sheet).
  explicit SurfaceTriangles(const FluidBody& body);
  /// Computes normals from the corners; 0 for a triangle without area.
  explicit SurfaceTriangles(const Surface& surface);
  /// Replaces the triangles by others on the same vertices, as the constructor for a surface.
  void setTriangles(std::vector<std::array<int, 3>> corners);

  int size() const { return static_cast<int>(corners_.size()); }
  bool isSheet() const { return is_sheet_; }
  int vertexCount() const { return static_cast<int>(places_.size()); }
  int vertex(int triangle, int corner) const { return corners_[index(triangle)][index(corner)]; }
  const Vector3& place(int vertex) const { return places_[index(vertex)]; }
  /// Places of vertices [m].
  std::vector<Vector3> places(const std::vector<int>& vertices) const;
  /// Index of a vertex among those of the surface; of several at one place the first one.
  std::int32_t source(int vertex) const { return sources_[index(vertex)]; }
  const Vector3& normal(int triangle) const { return normals_[index(triangle)]; }
  /// Area of a triangle [m^2].
  double area(int triangle) const;
  /// Turn of the normal of a triangle, at most, by rounding of its corners to single precision.
  double turnByRounding(int triangle) const;
  /// Distance by which that rounding moves a vertex, at most [m].
  double rounding() const { return rounding_; }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void weld(const Surface& surface);

  bool is_sheet_ = false;
  double rounding_ = 0;
  std::vector<Vector3> places_;
  std::vector<std::int32_t> sources_;  ///< of the vertices
  std::vector<std::array<int, 3>> corners_;
  std::vector<Vector3> normals_;  ///< unit, into the fluid, one per triangle
};

/// A flat part of the surface with one convex outline.
struct FlatSide {
  std::vector<int> triangles;  ///< indices into the mesh, one or more
  std::vector<int> corners;    ///< vertices, counter-clockwise seen from the fluid, 3 or more
  Vector3 normal;              ///< unit, into the fluid
  bool is_in_rows =
      false;  ///< true: vertices between corners lie where it goes on smoothly, and none inside
  bool has_sharp_rim = false;  ///< true: an edge to all that it borders on, kEdgeCosine
};

/// Finds the flat sides. A triangle belongs to at most one side; to none if the outline of its
/// plane is not convex or has holes. Cost O(F log F).
std::vector<FlatSide> findFlatSides(const SurfaceTriangles& mesh);

/// The surface of a body, on which fans of few triangles replace those of divided flat sides.
/// Sides in rows stay: those of a cone in rings tell how its curvature changes.
struct WholeSides {
  /// @throws std::invalid_argument as SurfaceTriangles()
  explicit WholeSides(const FluidBody& body);

  SurfaceTriangles mesh;   ///< vertices are those of the body
  std::vector<int> face;   ///< for each triangle that of the body; kOfFan: a new one
  std::vector<int> side;   ///< for each triangle the number of its side
  std::vector<int> parts;  ///< for each triangle of the body the number of its side
  int count = 0;           ///< of sides

  static constexpr int kOfFan = -1;
};

}  // namespace ambient
