#include "demos/rivals/linear_drag.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace ambient {

LinearDrag::LinearDrag(double drag_speed) : drag_speed_(drag_speed) {
  if (!(drag_speed > 0) || !std::isfinite(drag_speed))
    throw std::invalid_argument("speed of the linear drag is " + std::to_string(drag_speed) +
                                " m/s; must be positive and finite");
}

Wrench LinearDrag::load(const FaceTable& faces, const Twist& relative_twist,
                        const LoadSettings& settings) const noexcept {
  Wrench sum;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vector3 centroid = faces.centroid(i);
    sum += Wrench::ofForceAt(faces.area[i] * relative_twist.at(centroid), centroid);
  }
  return -settings.density * drag_speed_ * sum;
}

}  // namespace ambient
