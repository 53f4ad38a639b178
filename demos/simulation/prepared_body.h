#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// What Bullet collides: one convex primitive of half sizes `size`, or points and triangles. In the
/// shape's frame, primitives centred at its origin with their axis along z.
struct CollisionGeometry {
  enum class Kind { kSphere, kBox, kCylinder, kCapsule, kCone, kConvexHull, kTriangles };
  Kind kind = Kind::kConvexHull;
  Vector3 size = Vector3::Zero();  ///< sphere: radius, -, -; box: half sizes; cylinder, capsule,
                                   ///< cone: radius, -, height [m]
  std::vector<Vector3> points;     ///< [m]
  std::vector<std::int32_t> triangles;  ///< of kTriangles, three indices each
};

/// One body of a scene, ready for the world. The shape's frame S is that of the scene file.
struct PreparedBody {
  CollisionGeometry collision;
  std::shared_ptr<const FluidBody> fluid_body;  ///< null: the fluid does not act on it
  Vector3 fluid_origin = Vector3::Zero();       ///< origin of the fluid body's frame F in S [m]
  Vector3 centre_of_mass = Vector3::Zero();     ///< in S [m]
  double mass = 0;                              ///< [kg]; 0: static
  Matrix3 inertia = Matrix3::Zero();            ///< about the centre of mass, S's axes [kg m^2]
};

}  // namespace ambient
