#include "bullet_ambient/force/face_flow.h"

#include "bullet_ambient/force/skin_friction.h"
#include "bullet_ambient/spatial/ambient_assert.h"

namespace ambient {

FaceFlow computeFaceFlow(const FaceTable& faces, std::size_t face, double reference_length,
                         const Twist& relative_twist, const LoadSettings& settings) noexcept {
  AMBIENT_ASSERT(face < faces.size());
  const Vector3 n = faces.normal(face);
  const Vector3 u = relative_twist.at(faces.centroid(face));
  FaceFlow flow;
  flow.is_attached = n.dot(u) > settings.separation_cosine * u.norm();
  if (!flow.is_attached) return flow;
  flow.slip = n.dot(u) * n - u;
  const double speed = flow.slip.norm();
  const double area = faces.area[face];
  flow.pressure = -0.5 * settings.density * speed * speed * area * n;
  const double reynolds = settings.reynoldsPerSpeed(reference_length) * speed;
  if (!(reynolds > 0)) return flow;
  const double coefficient = kFrictionCoefficient * reynoldsPower(reynolds);
  flow.friction = 0.5 * coefficient * settings.density * speed * area * flow.slip;
  return flow;
}

}  // namespace ambient
