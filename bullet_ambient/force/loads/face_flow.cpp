#include "bullet_ambient/force/loads/face_flow.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/law/face_pressure.h"
#include "bullet_ambient/force/law/shape_factors.h"
#include "bullet_ambient/force/law/skin_friction.h"

namespace ambient {
namespace {

/// q of the pressure on a face; `strength`: squared slip where the flow is attached [m^2/s^2].
double pressureOn(const FaceTable& faces, std::size_t face, const Twist& x, double strength,
                  const LoadSettings& settings) noexcept {
  const Vector3 n = faces.normal(face), u = x.at(faces.centroid(face));
  const double normal_speed = n.dot(u), whole_sq = u.squaredNorm();
  const ShapeFactors* const factors = settings.shape;
  const double slip_share = factors ? factors->slipShare(settings.separation_cosine) : 0;
  const auto speed = [&] {
    if (!factors) return u.norm();
    const Vector3 t = u - normal_speed * n;
    const double along = factors->shape.slender.dot(t);
    return speedAcross(normal_speed, t.squaredNorm() - along * along, u.norm());
  };
  const auto wing = [&](const auto& law) {
    const FormShape& shape = factors->shape;
    const double rate = shape.pitching.dot(x.angular);
    const double arm = shape.pitchingArm(n, faces.centroid(face));
    const WingFactors<double>& numbers = factors->in_double;
    const double(&h)[3] = numbers.span;
    constexpr double kLeast = 1e-200;  // at rest its inverse is finite
    const WingFlow<PlainArithmetic<double>> flow{
        shape.facing.dot(u), Vector3(h[0], h[1], h[2]).dot(u), normal_speed - rate * arm,
        whole_sq + kLeast, std::sqrt(whole_sq)};
    return law(flow, numbers);
  };
  const auto of_face = [&] { return formFactors<double>(faces.sharpness[face]); };
  const FaceState state{normal_speed, 1.0, strength, slip_share, speed, of_face, wing};
  const bool acts = factors && factors->actOnFaces();
  return withPressure(settings.law, acts ? &factors->in_double : nullptr,
                      [&](auto law) { return decltype(law)::template of<false>(state).total; });
}

}  // namespace

FaceFlow computeFaceFlow(const FaceTable& faces, std::size_t face, double reference_length,
                         const Twist& relative_twist, const LoadSettings& settings) noexcept {
  AMBIENT_ASSERT(face < faces.size());
  AMBIENT_ASSERT(settings.law != PressureLaw::kForm || face < faces.sharpness.size());
  const Vector3 n = faces.normal(face);
  const Vector3 u = relative_twist.at(faces.centroid(face));
  FaceFlow flow;
  const double normal_speed = n.dot(u);
  const double force = -0.5 * settings.density * faces.area[face];
  flow.is_attached = normal_speed > settings.separation_cosine * u.norm();
  if (flow.is_attached) flow.slip = normal_speed * n - u;
  const double speed = flow.slip.norm();
  const double pressure = pressureOn(faces, face, relative_twist, speed * speed, settings);
  flow.pressure = force * pressure * n;
  if (!flow.is_attached) return flow;
  const double reynolds = settings.reynoldsPerSpeed(reference_length) * speed;
  if (!(reynolds > 0)) return flow;
  const double coefficient = kFrictionCoefficient * reynoldsPower(reynolds);
  flow.friction = -coefficient * force * speed * flow.slip;
  return flow;
}

}  // namespace ambient
