#pragma once

#include <functional>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

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

/// Computes the added mass of the part of a mesh below any plane, see solveImageFlow() in
/// image_flow.h; about the mesh's origin, in its axes.
Matrix6 solveImageFlow(const TriangleMesh& body, const SurfacePlane& plane, int panels);

}  // namespace ambient
