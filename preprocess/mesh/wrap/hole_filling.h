#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Share of the area of a surface above which a loop of open edges is the rim of a sheet [1].
constexpr double kSheet = 0.9;

/// A mesh with filled holes.
struct FilledMesh {
  TriangleMesh mesh;
  int holes = 0;
  double area = 0;        ///< area of the triangles that fill them [m^2]
  bool is_sheet = false;  ///< true: one loop would take more than kSheet of the area of all
};

/// Fills the loops of open edges with triangles on their vertices. A surface with a loop that would
/// take more than kSheet of its own area is a sheet, and stays open: a plate, a sail, a patch among
/// others. Cost O(T log T), and O(n^2 log n) for a loop of n edges.
/// @pre indices are in range, coordinates finite.
FilledMesh withHolesFilled(const TriangleMesh& mesh);

}  // namespace ambient
