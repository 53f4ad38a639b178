#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A closed mesh divided into what the water outside sees and the rooms inside; docs/theory.md
/// section 20. Without holds `closed` is empty: the mesh stays as it is.
struct Vessel {
  TriangleMesh closed;             ///< outer faces, and lids across the openings
  std::vector<Hold> holds;         ///< in the frame of the mesh
  std::vector<std::string> lines;  ///< what a user should know, one line each
};

/// Length and middle of the outline of an opening [m].
struct Rim {
  double length = 0;
  Vector3 centre{0, 0, 0};
};
Rim rimOf(const HoldOpening& opening);

/// Says what a hold is, in half a line: "hold of 0.9 m^3, rim 5.84 m round at (0, 0, 0.5)".
/// @param hold in any unit of length
/// @param unit a length of 1 of the hold in metres
std::string holdText(const Hold& hold, double unit = 1);

/// The inertia, per mass, of fluid that fills a closed room, as it resists turning: that of the box
/// with the room's moments, docs/theory.md eq. (133). Exact for boxes to 4 digits.
/// @param inertia of the room as if it were rigid, per mass, about its centre [m^2]
Matrix3 turningInertia(const Matrix3& inertia);

/// Converts a surface to a mesh.
TriangleMesh meshOf(const Surface& surface);

/// Converts a mesh to a surface.
Surface surfaceOf(const TriangleMesh& mesh);

/// Moves a hold.
Hold moved(Hold hold, const Vector3& by);

/// Closed surfaces of all holds, normals into them: what the walls leave empty.
TriangleMesh emptied(const std::vector<Hold>& holds);

/// The walls of a vessel as they are seen: its closed surface and its holds' without the lids, on
/// which both lie with opposite normals.
TriangleMesh wallsOf(const TriangleMesh& closed, const std::vector<Hold>& holds);

}  // namespace ambient
