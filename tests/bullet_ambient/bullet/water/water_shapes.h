#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient::test {

/// Shapes of bodies that float.
enum class WaterShape {
  kBall,
  kBox,    ///< 1 : 0.7 : 0.45
  kHull,   ///< convex, 14 points
  kAngle,  ///< two bars, one across an end of the other: not convex
  kCube,
};
constexpr int kWaterShapes = 5;

/// Collision shape and fluid body of one body. B has the centre and principal axes of a uniform
/// mass.
struct SizedShape {
  std::unique_ptr<btCompoundShape> collision;
  std::unique_ptr<btCollisionShape> parts[2];  ///< children of a compound
  std::shared_ptr<const FluidBody> fluid_body;
  FrameOffset fluid_frame;   ///< F in B
  Vector3 moments{0, 0, 0};  ///< moments of a uniform mass of 1 kg [m^2]
};

/// Makes a shape with longest side or diameter about `size` [m]. Cost: some tenths of a second for
/// the first one of a shape.
SizedShape makeWaterShape(WaterShape shape, double size);

/// Radius of a sphere about the centre of mass around any shape of size 1 m.
constexpr double kWaterShapeRadius = 0.87;

}  // namespace ambient::test
