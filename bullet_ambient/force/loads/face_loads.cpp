#include "bullet_ambient/force/loads/face_loads.h"

#include <cmath>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/face_pressure.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/law/share_in_pool.h"
#include "bullet_ambient/force/law/skin_friction.h"
#include "bullet_ambient/force/law/wet_share.h"
#include "bullet_ambient/force/medium/surface_plane.h"

namespace ambient {

namespace {

/// Returns the share of a face below the plane and between the sides of its water, docs/theory.md
/// eq. (59).
double wetShare(const FaceTable& faces, std::size_t face, const SurfacePlane& plane) noexcept {
  const Vector3 centroid = faces.centroid(face), normal = faces.normal(face);
  const double radius_sq = faces.area[face] / kPi;
  const double share = wetShareOf(plane.depth(centroid), plane.normal.dot(normal), radius_sq,
                                  [](double x) { return std::sqrt(x); });
  return plane.sides_F ? share * shareInPool(*plane.sides_F, centroid, normal, radius_sq) : share;
}

/// q of the pressure on a face, and q_L mu of wings, eq. (43d).
struct PressureOnFace {
  double total, pitch;
};

/// `strength`: squared slip where the flow is attached [m^2/s^2].
PressureOnFace pressureOn(const FaceTable& faces, std::size_t face, const Twist& x, double strength,
                          const LoadSettings& settings) noexcept {
  const Vector3 n = faces.normal(face), u = x.at(faces.centroid(face));
  const double normal_speed = n.dot(u), whole_sq = u.squaredNorm();
  const ShapeFactors* const factors = settings.shape;
  const auto speed = [&] {
    if (!factors) return u.norm();
    const Vector3 t = u - normal_speed * n;
    const double along = factors->shape.slender.dot(t);
    return speedAcross(normal_speed, t.squaredNorm() - along * along, u.norm());
  };
  double pitch = 0;
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
    const FacePressure<double> pressure = law(flow, numbers);
    pitch = pressure.lift * arm;
    return pressure;
  };
  const auto of_face = [&] { return formFactors<double>(faces.sharpness[face]); };
  const FaceState state{normal_speed, 1.0, strength, speed, of_face, wing};
  const bool acts = factors && factors->actOnFaces();
  const double total = withPressure(settings.law, acts ? &factors->in_double : nullptr,
                                    [&](auto law) { return decltype(law)::of(state).total; });
  return {total, pitch};
}

}  // namespace

double separationCosine(double separation_angle) {
  const double right_angle = portable::acos(0.0);
  const double rounding = 4 * std::numeric_limits<double>::epsilon();
  if (std::abs(separation_angle - right_angle) <= rounding) return 0;
  return portable::cos(separation_angle);
}

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
  const PressureOnFace pressure = pressureOn(faces, face, relative_twist, speed * speed, settings);
  flow.pressure = force * pressure.total * n;
  if (settings.shape) flow.moment = -force * pressure.pitch * settings.shape->shape.pitching;
  if (!flow.is_attached) return flow;
  const double reynolds = settings.reynoldsPerSpeed(reference_length) * speed;
  if (!(reynolds > 0)) return flow;
  const double coefficient = kFrictionCoefficient * reynoldsPower(reynolds);
  flow.friction = -coefficient * force * speed * flow.slip;
  return flow;
}

FaceLoads computeFaceLoads(const FaceTable& faces, double reference_length,
                           const Twist& relative_twist, const LoadSettings& settings,
                           const SurfacePlane* plane) noexcept {
  AMBIENT_ASSERT(settings.separation_cosine >= -1 && settings.separation_cosine <= 0);
  AMBIENT_ASSERT(settings.density >= 0 && reference_length >= 0);
  AMBIENT_ASSERT(!settings.shape || settings.law == PressureLaw::kForm);
  FaceLoads loads;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const double share = plane ? wetShare(faces, i, *plane) : 1;
    if (!(share > 0)) continue;
    const FaceFlow flow = computeFaceFlow(faces, i, reference_length, relative_twist, settings);
    const Vector3 c = faces.centroid(i);
    loads.pressure += share * Wrench::ofForceAt(flow.pressure, c);
    loads.pressure.torque += share * flow.moment;
    loads.friction += share * Wrench::ofForceAt(flow.friction, c);
  }
  return loads;
}

double ownDrag(const FaceTable& faces, const ShapeFactors& shape, const Vector3& direction,
               double frontal_area) {
  const LoadSettings settings{1, 0, 0, false, PressureLaw::kForm, &shape};
  double force = 0;
  for (const double way : {1.0, -1.0}) {
    const Twist x{Vector3::Zero(), way * direction};
    force -= way * computeFaceLoads(faces, 1, x, settings).pressure.force.dot(direction);
  }
  return frontal_area > 0 ? force / frontal_area : 0;
}

DragScale::DragScale(const FluidBody& body, const FaceTable& faces, const ShapeFactors& shape)
    : is_measured_(!body.drag.isZero(0)), centre_(body.centre_of_volume), length_sq_(body.area) {
  AMBIENT_ASSERT(faces.sharpness.size() == faces.size());
  if (!is_measured_) return;
  for (int axis = 0; axis < 3; ++axis) {
    double frontal_area = 0;
    for (std::size_t i = 0; i < faces.size(); ++i)
      frontal_area += 0.5 * faces.area[i] * std::abs(faces.normal(i)[axis]);
    const double drag = ownDrag(faces, shape, Vector3::Unit(axis), frontal_area);
    AMBIENT_ASSERT(std::isfinite(drag));
    if (drag > 0) scales_[axis] = body.drag[axis] / drag;
  }
}

Wrench DragScale::scaled(const Wrench& load, const Twist& x) const noexcept {
  if (!is_measured_) return load;
  const Vector3 v = x.at(centre_), along = v.cwiseAbs2();
  const double turning = length_sq_ * x.angular.squaredNorm();
  const double sum = along.sum() + turning;
  if (!(sum > 0)) return load;
  const double factor = (scales_.dot(along) + scales_.mean() * turning) / sum;
  const double power = load.torque.dot(x.angular) + load.force.dot(x.linear);
  const double more = (factor - 1) * power / sum;
  const Vector3 force = more * v;
  return load + Wrench{more * length_sq_ * x.angular + centre_.cross(force), force};
}

}  // namespace ambient
