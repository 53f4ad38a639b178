#include "bullet_ambient/force/loads/face_loads.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/law/face_pressure.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/law/skin_friction.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

double shareInPool(const PoolSides& sides, const Vector3& centroid, const Vector3& normal,
                   double radius_sq) noexcept {
  double share = 1;
  for (int i = 0; i < sides.count; ++i) {
    const PoolSides::Side& side = sides.of[i];
    share *= wetShareOf(side.normal.dot(side.point - centroid), side.normal.dot(normal), radius_sq,
                        [](double x) { return std::sqrt(x); });
  }
  return share;
}

namespace {

/// Returns the share of a face below the plane and between the sides of its water, docs/theory.md
/// eq. (59).
double wetShareOfFace(const FaceTable& faces, std::size_t face,
                      const SurfacePlane& plane) noexcept {
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
    const double facing = shape.facing.dot(u);
    const double stalling = factors->stallingShare(x.angular, x.linear) * facing;
    const WingFlow<PlainArithmetic<double>> flow{facing,
                                                 stalling,
                                                 Vector3(h[0], h[1], h[2]).dot(u),
                                                 normal_speed - rate * arm,
                                                 whole_sq + kLeastSpeedSq,
                                                 std::sqrt(whole_sq)};
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
    const double share = plane ? wetShareOfFace(faces, i, *plane) : 1;
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
  for (const double sign : {1.0, -1.0}) {
    const Twist x{Vector3::Zero(), sign * direction};
    force -= sign * computeFaceLoads(faces, 1, x, settings).pressure.force.dot(direction);
  }
  return frontal_area > 0 ? force / frontal_area : 0;
}

namespace {

/// 2^exponent, exponent in [-1022, 1023].
inline double powerOfTwo(int exponent) noexcept {
  constexpr int kBias = 1023;
  const std::uint64_t bits = static_cast<std::uint64_t>(exponent + kBias) << 52;
  double power;
  std::memcpy(&power, &bits, sizeof power);
  return power;
}

/// Returns n of the smallest unit 32^n above a speed [m/s], with exponents of two between -1000 and
/// 1000; 0 if the speed is not positive and finite. The unit's power -1/5 is a power of two, too.
inline int speedUnitAbove(double speed) noexcept {
  if (!(speed > 0) || !std::isfinite(speed)) return 0;
  constexpr int kBias = 1023;
  const double normal = std::clamp(speed, 0x1p-1000, 0x1p999);
  std::uint64_t bits;
  std::memcpy(&bits, &normal, sizeof bits);
  static_assert(kReynoldsExponent == -1.0 / 5, "other powers need other units");
  return (static_cast<int>(bits >> 52) - kBias + 1005) / 5 - 200;
}

inline void round(const Vector3& from, float (&to)[3]) noexcept {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(from[axis]);
}

/// Rounds w and v, in units of `length` [m] and of a speed in which all components are at most 1,
/// and adds what the form law asks of a shape, eq. (43d).
inline SingleMotion singleMotion(const Vector3& w, const Vector3& v, double length,
                                 const LoadSettings& settings) noexcept {
  SingleMotion single{};
  round(w, single.angular);
  round(v, single.linear);
  const double cosine = settings.separation_cosine;
  single.signed_cosine_sq = static_cast<float>(-cosine * std::abs(cosine));
  single.sine_sq = static_cast<float>(1 - cosine * cosine);
  single.law = settings.law;
  if (!settings.shape || !settings.shape->actOnFaces()) return single;
  const ShapeFactors& factors = *settings.shape;
  const FormShape& shape = factors.shape;
  const double rate = shape.pitching.dot(w);
  single.wing = &factors.in_single;
  single.pitching_rate = static_cast<float>(rate);
  if (factors.in_single.is_part)
    single.stalling_share = static_cast<float>(factors.stallingShare(w, v, length));
  round(w - rate * shape.pitching, single.pitched_angular);
  round(v + rate / length * shape.pitching.cross(shape.centre), single.pitched_linear);
  return single;
}

SingleCut cutBy(const SurfacePlane& plane, const PackedFaces& faces) noexcept {
  const double length = faces.lengthUnit();
  AMBIENT_ASSERT(isUnit(plane.normal));
  const Eigen::Vector3f s = plane.normal.cast<float>();
  // The clamp keeps single precision finite; farther away only the side of the plane matters.
  const double height = std::clamp(plane.height / length, -1e6, 1e6);
  return {{s.x(), s.y(), s.z()},
          static_cast<float>(height),
          static_cast<float>(faces.areaUnit() / (kPi * length * length))};
}

}  // namespace

Wrench computeFaceLoad(const PackedFaces& faces, double reference_length,
                       const Twist& relative_twist, const LoadSettings& settings,
                       const SurfacePlane* plane) noexcept {
  AMBIENT_ASSERT(faces.size() == 0 ||
                 (settings.law == PressureLaw::kForm) == (faces.blocks().sharpness != nullptr));
  AMBIENT_ASSERT(!settings.shape || settings.law == PressureLaw::kForm);
  AMBIENT_ASSERT(settings.density >= 0 && reference_length >= 0);
  const double length = faces.lengthUnit();
  const Vector3 turning = length * relative_twist.angular, &linear = relative_twist.linear;
  const int unit =
      speedUnitAbove(std::max(turning.cwiseAbs().maxCoeff(), linear.cwiseAbs().maxCoeff()));
  const double speed = powerOfTwo(5 * unit), per_speed = powerOfTwo(-5 * unit);
  SingleMotion motion = singleMotion(per_speed * turning, per_speed * linear, length, settings);
  // C_f at a slip of one unit of speed, eq. (16). The limit, reached at Re < 1e-153, keeps single
  // precision finite. Only the last factor depends on the motion.
  const double reynolds = settings.reynoldsPerSpeed(reference_length);
  if (reynolds > 0)
    motion.friction = static_cast<float>(
        std::min(kFrictionCoefficient * reynoldsPower(reynolds) * powerOfTwo(-unit), 1e30));
  const SingleCut cut = plane ? cutBy(*plane, faces) : SingleCut{};
  if (plane) motion.cut = &cut;
  LoadSums sums = kSumBlocks.fastest()(faces.blocks(), motion);
  if (motion.wing)
    for (int axis = 0; axis < 3; ++axis)
      sums.wrench[axis] -= settings.shape->shape.pitching[axis] * sums.pitch;
  const double force = -0.5 * settings.density * speed * speed * faces.areaUnit();  // eq. (15)
  const double torque = force * length;
  const double(&s)[6] = sums.wrench;
  return {{torque * s[0], torque * s[1], torque * s[2]},
          {force * s[3], force * s[4], force * s[5]}};
}

namespace {

/// Adds the triangle of three places near the sphere: its centroid, moved onto the sphere, with the
/// solid angle of the triangle.
void addTriangle(const Vector3& a, const Vector3& b, const Vector3& c, FaceTable& faces) {
  const Vector3 centroid = (a + b + c) / 3, outward = centroid.normalized();
  const double across = std::abs((b - a).cross(c - a).dot(outward)) / 2;
  faces.add(outward, outward, across / centroid.squaredNorm());
}

/// Faces of one octant: kEdge^2 triangles between the directions of a lattice.
void addOctant(const Vector3& signs, FaceTable& faces) {
  constexpr int kEdge = 12;
  const auto place = [&](int i, int j) {
    return signs.cwiseProduct(Vector3(i, j, kEdge - i - j)).normalized();
  };
  for (int i = 0; i < kEdge; ++i)
    for (int j = 0; i + j < kEdge; ++j) {
      addTriangle(place(i, j), place(i + 1, j), place(i, j + 1), faces);
      if (i + j + 1 == kEdge) continue;
      addTriangle(place(i + 1, j), place(i, j + 1), place(i + 1, j + 1), faces);
    }
}

FluidBody makeSphere() {
  FluidBody sphere;
  sphere.name = "sphere";
  sphere.sphere_radius = 1;
  sphere.area = 4 * kPi;
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0}) addOctant({x, y, z}, sphere.faces);
  double sum = 0;
  for (const double area : sphere.faces.area) sum += area;
  for (double& area : sphere.faces.area) area *= sphere.area / sum;
  sphere.form.faces = sphere.faces;
  sphere.form.faces.sharpness.assign(sphere.faces.size(), 0);
  sphere.form.shape.edges = 0;
  return sphere;
}

}  // namespace

std::shared_ptr<const FluidBody> unitSphere() {
  static const auto sphere = std::make_shared<const FluidBody>(makeSphere());
  return sphere;
}

SurfaceElsewhere::SurfaceElsewhere(const SurfacePlane& there, const FrameOffset& pose,
                                   double unit) noexcept
    : plane(there) {
  plane.height /= unit;
  if (!plane.sides_F) return;
  sides.count = plane.sides_F->count;
  for (int i = 0; i < sides.count; ++i) {
    const PoolSides::Side& side = plane.sides_F->of[i];
    sides.of[i] = {pose.rotation.transpose() * side.normal,
                   pose.rotation.transpose() * (side.point - pose.translation) / unit};
  }
  plane.sides_F = &sides;
}

}  // namespace ambient
