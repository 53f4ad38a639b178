#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// A shape of the stability atlas, scaled to 1 m: its longest side or diameter.
struct AtlasShape {
  std::string name;
  std::shared_ptr<const FluidBody> body;  ///< F: the centre of volume, the shape's axes
  double solid_volume = 0;                ///< volume for the mass; sheet: 1 % of its area x 1 m
  double separation_angle = 0;            ///< [rad]
  Vector3 half_size = Vector3::Zero();    ///< half extents of the bounding box [m]
};

/// Shapes: sphere, plates of 5:1 and 200:1, a sheet without thickness, a cone with separation at
/// 1.5 pi/2. A propeller (plate twisted by a right angle), a chiral body (box twisted and
/// sheared), a tetrahedron; last, a needle of 1000:1. Cost: eight boundary element solutions, some
/// seconds.
std::vector<AtlasShape> makeAtlasShapes();

}  // namespace ambient
