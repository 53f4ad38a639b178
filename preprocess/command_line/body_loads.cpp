#include "preprocess/command_line/body_loads.h"

#include <cmath>

#include "bullet_ambient/force/sphere_loads.h"

namespace ambient {

BodyLoads::BodyLoads(const FluidBody& body, const LoadSettings& settings)
    : body_(body), settings_(settings) {
  if (body.sphere_radius > 0 && needsSphereTable(settings))
    table_ = sharedSphereTable(settings.separation_cosine);
}

FaceLoads BodyLoads::at(const Twist& x) const {
  const double length = std::sqrt(body_.area);
  if (!(body_.sphere_radius > 0)) return computeFaceLoads(body_.faces, length, x, settings_);
  const Vector3& centre = body_.centre_of_volume;
  FaceLoads loads = computeSphereLoads(table_.get(), body_.sphere_radius, length,
                                       {x.angular, x.at(centre)}, settings_);
  for (Wrench* load : {&loads.pressure, &loads.friction}) load->torque += centre.cross(load->force);
  return loads;
}

}  // namespace ambient
