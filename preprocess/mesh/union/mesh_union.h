#pragma once

#include <optional>
#include <string>
#include <vector>

#include "preprocess/mesh/checked_mesh.h"

namespace ambient {

/// The union of closed surfaces that touch or overlap: each keeps what of it lies outside the
/// others, so that sharp edges stay sharp. Where that leaves no closed surface, as when they touch
/// in an edge, they are blown up about their centres by 0.03 %, then by 0.12 %. Then, for parts
/// with sides that lie nearly flush, so that slivers as narrow as these tolerances are left, each
/// is blown up by a share of its own of 0.03 to 0.12 %, turned by some 1e-5 rad, and cut to
/// rounding: up to four times with other numbers, the same ones in every call. Cost O(T P) for
/// triangles T of one and planes P of those whose bounding boxes it meets.
/// @pre each is closed, manifold and outward.
/// @throws std::runtime_error with the reason, if no closed surface of the right volume comes out.
CheckedMesh uniteMeshes(const std::vector<TriangleMesh>& parts, const std::string& name);

/// The union of the closed parts of a mesh that overlap, touch, lie in each other or have edges in
/// common, whichever way round they are, with a warning. None if the mesh is open, of one part, or
/// cannot be united.
std::optional<CheckedMesh> uniteClosedParts(const TriangleMesh& mesh, const std::string& name);

}  // namespace ambient
