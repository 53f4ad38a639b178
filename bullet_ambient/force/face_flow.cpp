#include "bullet_ambient/force/face_flow.h"

#include "bullet_ambient/force/form_pressure.h"
#include "bullet_ambient/force/skin_friction.h"
#include "bullet_ambient/spatial/ambient_assert.h"

namespace ambient {

FaceFlow computeFaceFlow(const FaceTable& faces, std::size_t face, double reference_length,
                         const Twist& relative_twist, const LoadSettings& settings) noexcept {
  AMBIENT_ASSERT(face < faces.size());
  const Vector3 n = faces.normal(face);
  const Vector3 u = relative_twist.at(faces.centroid(face));
  FaceFlow flow;
  const double normal_speed = n.dot(u);
  const bool is_form = settings.law == PressureLaw::kForm;
  AMBIENT_ASSERT(!is_form || face < faces.sharpness.size());
  const double force = -0.5 * settings.density * faces.area[face];
  if (is_form)
    flow.pressure =
        force * formPressure(normal_speed, u.norm(), formFactors<double>(faces.sharpness[face])) *
        n;
  flow.is_attached = normal_speed > settings.separation_cosine * u.norm();
  if (!flow.is_attached) return flow;
  flow.slip = normal_speed * n - u;
  const double speed = flow.slip.norm();
  if (!is_form || normal_speed <= 0) flow.pressure += force * speed * speed * n;
  const double reynolds = settings.reynoldsPerSpeed(reference_length) * speed;
  if (!(reynolds > 0)) return flow;
  const double coefficient = kFrictionCoefficient * reynoldsPower(reynolds);
  flow.friction = -coefficient * force * speed * flow.slip;
  return flow;
}

}  // namespace ambient
