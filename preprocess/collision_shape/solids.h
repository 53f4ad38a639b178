#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {

/// A closed part of a collision shape, in the shape's frame, with the volume of the smooth body.
struct Solid {
  TriangleMesh mesh;  ///< triangles for the loads
  TriangleMesh
      flow;  ///< finer triangles of the same body for the flow alone; empty: `mesh` is used
  TriangleMesh coarse_flow;  ///< coarser triangles for the flow: from these to `flow`, the error
                             ///< shrinks as 1 / flow_ratio
  double flow_ratio =
      0;  ///< ratio of the numbers of triangles, to extrapolate the result; 0: no extrapolation
  TriangleMesh cavities;  ///< closed surfaces inside the body; they only matter to the uniform mass
  /// Added mass from a closed form or a table, about the shape's origin, per unit density; none:
  /// neither exists.
  std::optional<Matrix6> added_mass;
  KnownViscousFlow viscous_flow;      ///< where the added mass is known, likewise
  bool is_polyhedron = false;         ///< its flat sides are the body's, and no approximation
  double sphere_radius = 0;           ///< radius of a sphere [m]; 0: any other shape
  std::string name;                   ///< name of the part: "crane: child 1: child 0 (Box)"
  std::vector<std::string> warnings;  ///< what a user should know about it, one line each
};

/// Largest number of triangles of many solids together, over the number aimed at, as far as their
/// kinds allow.
constexpr int kMostOfMany = 6;

/// Resolution of the triangles of solids.
struct SolidResolution {
  int faces = 0;        ///< number of triangles for the loads, of all solids together
  int least_faces = 0;  ///< least number per solid, unless that makes more than kMostOfMany allows
  int flow_faces = 0;   ///< number of triangles for the flow, of all solids together
  bool tables = true;   ///< of the added mass, as far as they reach
  bool strict = false;  ///< refuse triangles that are not a closed body
  double unit = 1;      ///< a length of 1 in metres, for warnings
};

/// Returns the added mass of a part about its own origin, in its axes, per unit density; none if
/// the tables of simple shapes do not have it.
std::optional<Matrix6> tabulatedAddedMass(const Shape& shape);

/// Makes the solids of the parts of a shape, in the frame of the shape. The number of faces is
/// divided among them.
/// @throws std::runtime_error in one line that begins with the part's name, for one that cannot be
/// a body in a fluid.
std::vector<Solid> makeSolids(const std::vector<PlacedShape>& parts,
                              const SolidResolution& resolution);

/// Divides the triangles of a mesh, leaving its surface as it is. Edges get at most 2.5 times as
/// long as those of `faces` equilateral triangles of the same area; longer, if narrow strips would
/// make more than twice as many triangles.
TriangleMesh evenlyDivided(const TriangleMesh& mesh, int faces);

/// Ways to join solids that touch. Each is tried where those before have failed.
enum class JoinedBy { kUnion, kWrap, kHull };

/// Solids with gaps between them, made of the solids of one shape.
struct SeparateSolids {
  std::vector<Solid> solids;
  bool are_joined = false;  ///< true: some of them are unions of solids, or wraps around them
};

/// Returns true if all of them are polyhedra.
bool arePolyhedra(const std::vector<Solid>& solids);

/// Unites solids that touch or overlap, or leave gaps too narrow for the flow (kLeastGap). Each
/// keeps what of its surface lies outside the others; where that leaves no closed surface, as when
/// they touch in an edge, they are blown up about their centres by 0.03 %, then by 0.12 %. For
/// those that cannot be united stands a surface wrapped around them, if it has the volume of the
/// union within 1 %, else their convex hull, with a warning. Cost O(T P) for triangles T of one and
/// planes P of the other.
/// @param solids of one shape, in its frame
/// @param faces triangles aimed at
/// @param name begins the warnings, which name two of them
/// @param by the first of the three to try
/// @param reason why what comes before `by` did not serve
SeparateSolids uniteSolids(const std::vector<Solid>& solids, int faces, const std::string& name,
                           JoinedBy by = JoinedBy::kUnion, const std::string& reason = {});

}  // namespace ambient
