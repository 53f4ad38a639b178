#include "demos/rivals/windward_flux.h"

#include <algorithm>

namespace ambient {

Wrench WindwardFlux::load(const FaceTable& faces, const Twist& relative_twist,
                          const LoadSettings& settings) const noexcept {
  Wrench sum;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vector3 centroid = faces.centroid(i);
    const Vector3 velocity = relative_twist.at(centroid);
    const double windward = std::max(faces.normal(i).dot(velocity), 0.0);
    sum += Wrench::ofForceAt(faces.area[i] * windward * velocity, centroid);
  }
  return -0.5 * settings.density * sum;
}

}  // namespace ambient
