#pragma once

#include <optional>
#include <string>
#include <vector>

#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Least gap between two solids, over the size of the smaller one [1]. The flow through narrower
/// gaps is not resolved.
constexpr double kLeastGap = 1e-3;

/// True if two closed surfaces cross, one lies inside the other, or a vertex of one is closer to
/// the other than kLeastGap. Cost O(T1 T2) if their bounding boxes meet.
bool areInContact(const TriangleMesh& a, const TriangleMesh& b);

/// How often uniteMeshes() tries: with the parts as they are, or with enlarged and turned ones,
/// too.
enum class UnionTries { kOne, kAll };

/// Computes the union of closed surfaces that touch or overlap: keeps the part of each that lies
/// outside the others, so that sharp edges stay sharp. If the result is not closed, for example
/// because parts touch in an edge, tries again with the parts enlarged about their centres by 0.03
/// %, then by 0.12 %. If that fails, too, for example for sides that are nearly flush, enlarges
/// each part by a different share of 0.03 to 0.12 %, turns it by some 1e-5 rad and cuts with
/// tolerances of rounding; up to four times with other random numbers, which are the same in every
/// call. Cost O(T P) for triangles T of one and planes P of those whose bounding boxes it meets.
/// @pre each is closed, manifold and outward.
/// @throws std::runtime_error with the reason, if no closed surface of the right volume comes out.
CheckedMesh uniteMeshes(const std::vector<TriangleMesh>& parts, const std::string& name,
                        UnionTries tries = UnionTries::kAll);

/// Computes the volume of the union of closed surfaces [m^3], also of those that uniteMeshes()
/// cannot unite, from what 300 by 300 lines across them have in it. Error: about 1e-4 of it.
/// @pre each is closed and outward.
double volumeOfUnion(const std::vector<TriangleMesh>& parts);

/// Unites the closed parts of a mesh that overlap, touch, lie in each other or have edges in
/// common, whatever their orientation; adds a warning. None if the mesh is open, has one part only,
/// or cannot be united.
std::optional<CheckedMesh> uniteClosedParts(const TriangleMesh& mesh, const std::string& name);

}  // namespace ambient
