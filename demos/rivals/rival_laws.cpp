#include "demos/rivals/rival_laws.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/force/loads/surface_loads.h"

namespace ambient {
namespace {

/// Drag against the velocity of each face: f_i = -factor A_i weight(n_i, u_i) u_i.
template <class Weight>
class FaceDrag : public SurfaceLoads {
 public:
  FaceDrag(std::shared_ptr<const FluidBody> body, double factor, Weight weight)
      : body_(std::move(body)), factor_(factor), weight_(weight) {}

  Wrench load(const Twist& relative_twist) const noexcept override {
    const FaceTable& faces = body_->faces;
    Wrench sum;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Vector3 centroid = faces.centroid(i);
      const Vector3 velocity = relative_twist.at(centroid);
      const double weight = weight_(faces.normal(i), velocity);
      sum += Wrench::ofForceAt(faces.area[i] * weight * velocity, centroid);
    }
    return -factor_ * sum;
  }
  int faces() const noexcept override { return static_cast<int>(body_->faces.size()); }

 private:
  std::shared_ptr<const FluidBody> body_;
  double factor_;
  Weight weight_;
};

template <class Weight>
LoadLaw faceDrag(double factor_per_density, Weight weight) {
  return [=](const std::shared_ptr<const FluidBody>& body, const LoadSettings& settings) {
    return std::make_shared<FaceDrag<Weight>>(body, settings.density * factor_per_density, weight);
  };
}

}  // namespace

LoadLaw linearDrag(double drag_speed) {
  if (!(drag_speed > 0) || !std::isfinite(drag_speed))
    throw std::invalid_argument("speed of the linear drag is " + std::to_string(drag_speed) +
                                " m/s; must be positive and finite");
  return faceDrag(drag_speed, [](const Vector3&, const Vector3&) { return 1.0; });
}

LoadLaw windwardFlux() {
  return faceDrag(0.5, [](const Vector3& n, const Vector3& u) { return std::max(n.dot(u), 0.0); });
}

}  // namespace ambient
