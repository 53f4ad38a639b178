#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/frame_offset.h"

namespace ambient::test {

/// Shapes of bodies that float.
enum class WaterShape {
  kBall,
  kBox,    ///< 1 : 0.7 : 0.45
  kHull,   ///< convex, of 14 points
  kAngle,  ///< two bars, one across an end of the other: not convex
  kCube,
};
constexpr int kWaterShapes = 5;

/// As Bullet collides with it and as the fluid sees it; both in the principal axes of a uniform
/// mass, its centre the origin.
struct SizedShape {
  std::unique_ptr<btCompoundShape> collision;
  std::unique_ptr<btCollisionShape> parts[2];  ///< of the compound
  std::shared_ptr<const FluidBody> fluid_body;
  FrameOffset fluid_frame;   ///< F in B
  Vector3 moments{0, 0, 0};  ///< of a uniform mass of 1 kg [m^2]
};

/// Of a longest side or diameter of about `size` [m]. Cost: of the first of a shape some tenths of
/// a second.
SizedShape makeWaterShape(WaterShape shape, double size);

/// Radius of a sphere about the centre of mass that holds any of the shapes of a size of 1 m.
constexpr double kWaterShapeRadius = 0.87;

}  // namespace ambient::test
