#pragma once

#include <cmath>

#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {

/// Pressure and friction on the first body of a scene for a motion about its centre of mass. Both
/// are in the body's axes.
inline Wrench loadOn(const Scene& scene, const PreparedBody& body, const Twist& motion_B) {
  LoadSettings settings;
  settings.density = scene.medium.density;
  settings.viscosity = scene.medium.viscosity;
  settings.separation_cosine = separationCosine(scene.bodies[0].attach.flow.separation_angle);
  FrameOffset fluid_frame;
  fluid_frame.translation = body.fluid_origin - body.centre_of_mass;
  const FluidBody& fluid = *body.fluid_body;
  return fluid_frame.toB(
      computeFaceLoads(fluid.faces, std::sqrt(fluid.area), fluid_frame.toF(motion_B), settings)
          .total());
}

/// Power of pressure and friction on the first body of a scene during its motion [W].
inline double powerOfLoads(const Scene& scene, const PreparedBody& body, const MotionSample& at) {
  const Quaternion to_body = at.orientation.conjugate();
  const Twist motion_B{to_body * at.twist.angular, to_body * at.twist.linear};
  return power(loadOn(scene, body, motion_B), motion_B);
}

/// Weight less buoyancy [N].
inline double weightIn(const Scene& scene, const PreparedBody& body) {
  return (body.mass - scene.medium.density * body.fluid_body->volume) * -scene.gravity.z();
}

}  // namespace ambient
