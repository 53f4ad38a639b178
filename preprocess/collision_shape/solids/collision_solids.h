#pragma once

#include <vector>

#include "preprocess/collision_shape/solids/solid.h"
#include "preprocess/shape/shape_facts.h"

namespace ambient {

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

}  // namespace ambient
