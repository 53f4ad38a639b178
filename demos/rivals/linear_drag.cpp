#include "demos/rivals/linear_drag.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/force/surface_loads.h"

namespace ambient {
namespace {

class LinearDrag : public SurfaceLoads {
 public:
  /// `traction`: rho c.
  LinearDrag(std::shared_ptr<const FluidBody> body, double traction)
      : body_(std::move(body)), traction_(traction) {}

  Wrench load(const Twist& relative_twist) const noexcept override {
    const FaceTable& faces = body_->faces;
    Wrench sum;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Vector3 centroid = faces.centroid(i);
      sum += Wrench::ofForceAt(faces.area[i] * relative_twist.at(centroid), centroid);
    }
    return -traction_ * sum;
  }
  int faces() const noexcept override { return static_cast<int>(body_->faces.size()); }

 private:
  std::shared_ptr<const FluidBody> body_;
  double traction_;
};

}  // namespace

LoadLaw linearDrag(double drag_speed) {
  if (!(drag_speed > 0) || !std::isfinite(drag_speed))
    throw std::invalid_argument("speed of the linear drag is " + std::to_string(drag_speed) +
                                " m/s; must be positive and finite");
  return [drag_speed](const std::shared_ptr<const FluidBody>& body, const LoadSettings& settings) {
    return std::make_shared<LinearDrag>(body, settings.density * drag_speed);
  };
}

}  // namespace ambient
