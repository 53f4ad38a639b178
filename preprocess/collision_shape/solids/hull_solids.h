#pragma once

#include <string>

#include "preprocess/collision_shape/solids/solid.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Resolution of the triangles of solids.
struct SolidResolution {
  int faces = 0;        ///< number of triangles for the loads, of all solids together
  int least_faces = 0;  ///< least number per solid, unless that makes more than kMostOfMany allows
  int flow_faces = 0;   ///< number of triangles for the flow, of all solids together
  bool tables = true;   ///< of the added mass, as far as they reach
  bool strict = false;  ///< refuse triangles that are not a closed body
  double unit = 1;      ///< a length of 1 in metres, for warnings
};

// Functions below throw std::runtime_error, beginning with `name`, if sizes are not positive and
// finite or points lie in a plane.

/// Makes the solid of a hull.
Solid makeHullSolid(const Hull& hull, const SolidResolution& resolution, const std::string& name);

/// Makes the solid of the hull of several ellipsoids; its volume is extrapolated from two
/// approximations by polyhedra.
Solid makeBallHullSolid(const BallHull& hull, const SolidResolution& resolution,
                        const std::string& name);

/// Divides the triangles of a mesh, leaving its surface as it is. Edges get at most 2.5 times as
/// long as those of `faces` equilateral triangles of the same area; longer, if narrow strips would
/// make more than twice as many triangles.
TriangleMesh evenlyDivided(const TriangleMesh& mesh, int faces);

}  // namespace ambient
