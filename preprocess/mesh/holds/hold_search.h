#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A hole in the wall of a hold that its mesh does not have, in the frame of the mesh.
struct GivenOpening {
  Vector3 place{0, 0, 0};   ///< [m]
  Vector3 normal{0, 0, 0};  ///< out of the hold
  double area = 0;          ///< [m^2]
};

/// How the holds of a mesh are found, and what a user gives beside them.
struct HoldSearch {
  bool is_wanted = true;              ///< false: a bowl is the body of its walls
  std::optional<Eigen::Vector3d> up;  ///< which way the mesh stands; none: see findHolds()
  double unit = 1;                    ///< a length of 1 of the mesh in metres, for the lines
  std::vector<std::filesystem::path> tanks = {};  ///< meshes that are holds without openings
  double tank_scale = 1;                          ///< from these files to the mesh
  std::vector<GivenOpening> openings = {};
};

/// Finds the holds of a mesh: rooms that hold water as the mesh stands. From its pools and from
/// outside, faces are taken over edges in the order of height; a hold does not grow over convex
/// edges of more than 40 degrees, nor does the outside before the holds have grown, so that both
/// meet at the rim. Lids of triangles span the rims. The closed mesh has the volume of the walls
/// and the holds, to rounding. Where the mesh crosses a lid, all holds end level instead, where
/// their pools would spill, if more are found so: triangles are divided there. A hold whose lid the
/// mesh still crosses, for something stands in it, is left out, which a line says; each of the
/// others has one line too.
///
/// Without a direction up, that one of the six along the axes counts whose holds are largest, +z if
/// they are as large within 1 %. If no pool is found, the mesh is tilted by 30 degrees to eight
/// sides: a hold with a hole in its lowest place has pools then, and two openings. Cost O(T log T)
/// for each direction.
/// @param mesh closed, manifold and outward: a checked body
/// @param search direction up and unit
/// @param name begins each line
Vessel findHolds(const TriangleMesh& mesh, const HoldSearch& search, const std::string& name);

}  // namespace ambient
