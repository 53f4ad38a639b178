#pragma once

#include <functional>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Returns the part of a closed mesh below the plane z = 0: open at the waterline, whose vertices
/// have exactly z = 0, or closed if no triangle reaches the plane. A side in the plane counts as
/// above it. Vertices closer than a thousandth of the size are joined. A dry mesh gives no
/// triangles.
TriangleMesh wetPartOf(const TriangleMesh& body);

/// A mesh below the plane z = 0 with its mirror image above, joined where z = 0. The triangles of
/// the mesh come first, those of the image follow in the same order, turned round.
struct MirroredMesh {
  TriangleMesh mesh;
  Eigen::VectorXi image;  ///< number of the image of each vertex of the wet part; the vertex itself
                          ///< on the waterline
};
MirroredMesh withImage(const TriangleMesh& wet);

/// Computes the added mass of the part of a closed body below the plane z = 0, on which the
/// potential is 0: the flow of fast motions. Per unit density, about the origin, rotation first;
/// symmetric; 0 of a dry body. The potential is odd in z: the wet part and its image are one body
/// in unbounded fluid, and n.(v + w x z) has the opposite sign at the image. The equations are
/// those of solvePotentialFlow(), docs/theory.md eq. (7) to (11), for odd jumps, on `panels` flat
/// panels of the wet part, or a few less. Error with 500 panels: 1 % (hemisphere).
/// @pre the mesh passed checkMesh() as a body
/// @throws std::runtime_error if the linear system cannot be solved
Matrix6 solveImageFlow(const TriangleMesh& body, int panels);

constexpr int kDefaultWaterlineSubdivisions = 4, kMostWaterlineSubdivisions = 16;

struct WaterlineSettings {
  int subdivisions = kDefaultWaterlineSubdivisions;  ///< subdivisions of the lattice of attitudes
  int panels = 600;  ///< panels of each solution; a mesh with more triangles is coarsened
  int threads = 0;   ///< 0: all cores; the result does not depend on it, bit for bit
  /// Called after each solved attitude with the numbers of solved and of all attitudes; one call at
  /// a time, from the threads that solve. Null: no calls.
  std::function<void(int done, int attitudes)> progress = nullptr;
};

/// Computes the correction to the parts of the added mass at the surface of still water, in
/// attitudes all around and at ten immersions; docs/theory.md eq. (61a). Attitudes that symmetries
/// of the body map to each other are solved once. Cost: 0.1 to 0.2 s of one core for each attitude
/// and immersion, by default 66 times 10 of them, 15 times 10 of a body with three planes of
/// symmetry.
/// @pre the body is no sheet and no sphere, and has parts of its added mass
/// @throws std::runtime_error if a flow cannot be solved, with the reason.
WaterlineTable makeWaterlineTable(const FluidBody& body, const WaterlineSettings& settings);

/// Computes the added mass of the part of a mesh below any plane, as above; about the mesh's
/// origin, in its axes.
Matrix6 solveImageFlow(const TriangleMesh& body, const SurfacePlane& plane, int panels);

}  // namespace ambient
