#include "demos/rivals/windward_flux.h"

#include <algorithm>
#include <utility>

#include "bullet_ambient/force/surface_loads.h"

namespace ambient {
namespace {

class WindwardFlux : public SurfaceLoads {
 public:
  WindwardFlux(std::shared_ptr<const FluidBody> body, double density)
      : body_(std::move(body)), density_(density) {}

  Wrench load(const Twist& relative_twist) const noexcept override {
    const FaceTable& faces = body_->faces;
    Wrench sum;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Vector3 centroid = faces.centroid(i);
      const Vector3 velocity = relative_twist.at(centroid);
      const double windward = std::max(faces.normal(i).dot(velocity), 0.0);
      sum += Wrench::ofForceAt(faces.area[i] * windward * velocity, centroid);
    }
    return -0.5 * density_ * sum;
  }
  int faces() const noexcept override { return static_cast<int>(body_->faces.size()); }

 private:
  std::shared_ptr<const FluidBody> body_;
  double density_;
};

}  // namespace

LoadLaw windwardFlux() {
  return [](const std::shared_ptr<const FluidBody>& body, const LoadSettings& settings) {
    return std::make_shared<WindwardFlux>(body, settings.density);
  };
}

}  // namespace ambient
