#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// One body of a scene, ready for the world. S: frame of the shape in the scene file.
struct PreparedBody {
  Surface surface;                              ///< triangles of the shape, in S [m]
  std::shared_ptr<const FluidBody> fluid_body;  ///< null: the fluid does not act on the body
  Vector3 fluid_origin = Vector3::Zero();       ///< origin of the fluid body's frame F in S [m]
  Vector3 centre_of_mass = Vector3::Zero();     ///< in S [m]
  double mass = 0;                              ///< [kg]; 0: static
  Matrix3 inertia = Matrix3::Zero();            ///< about the centre of mass, S's axes [kg m^2]
};

}  // namespace ambient
