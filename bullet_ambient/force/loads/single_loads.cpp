#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_faces.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/law/skin_friction.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

/// Unit of speed: a power of 32, so that speed^(-1/5) is a power of two, too.
struct SpeedUnit {
  double speed;                ///< [m/s]
  double inverse;              ///< 1 / speed
  double inverse_fifth_power;  ///< speed^(-1/5)
};

/// Smallest unit above a speed [m/s], with exponents of two between -1000 and 1000; 1 m/s if the
/// speed is not positive and finite.
inline SpeedUnit speedUnitAbove(double speed) noexcept {
  if (!(speed > 0) || !std::isfinite(speed)) return {1, 1, 1};
  constexpr int kBias = 1023;
  const double normal = std::clamp(speed, 0x1p-1000, 0x1p999);
  std::uint64_t bits;
  std::memcpy(&bits, &normal, sizeof bits);
  static_assert(kReynoldsExponent == -1.0 / 5, "other powers need other units");
  const int fifth = (static_cast<int>(bits >> 52) - kBias + 1005) / 5 - 200;
  const auto powerOfTwo = [](int exponent) {
    const std::uint64_t power_bits = static_cast<std::uint64_t>(exponent + kBias) << 52;
    double power;
    std::memcpy(&power, &power_bits, sizeof power);
    return power;
  };
  return {powerOfTwo(5 * fifth), powerOfTwo(-5 * fifth), powerOfTwo(-fifth)};
}

/// Motion in units of a length and of `unit`, so that all components are at most 1.
struct ScaledMotion {
  Vector3 angular, linear;
  SpeedUnit unit;
};

inline ScaledMotion scaledMotion(const Vector3& angular, const Vector3& linear,
                                 double length) noexcept {
  const Vector3 turning = length * angular;
  const SpeedUnit unit =
      speedUnitAbove(std::max(turning.cwiseAbs().maxCoeff(), linear.cwiseAbs().maxCoeff()));
  return {unit.inverse * turning, unit.inverse * linear, unit};
}

/// C_f at a slip of one unit of speed, eq. (16); 0 without friction. Limited to 1e30 (reached at
/// Re < 1e-153), which keeps single precision finite. Only the last factor depends on the motion.
inline double frictionAtUnitSpeed(const LoadSettings& settings, const SpeedUnit& unit,
                                  double reference_length) noexcept {
  const double reynolds_per_speed = settings.reynoldsPerSpeed(reference_length);
  if (!(reynolds_per_speed > 0)) return 0;
  return std::min(
      kFrictionCoefficient * reynoldsPower(reynolds_per_speed) * unit.inverse_fifth_power, 1e30);
}

/// Adds what the form law asks of a shape, eq. (43d). `length`: unit of length [m].
inline void addShape(const ShapeFactors& factors, const ScaledMotion& motion, double length,
                     SingleMotion& single) noexcept {
  if (!factors.actOnFaces()) return;
  const FormShape& shape = factors.shape;
  const double rate = shape.pitching.dot(motion.angular);
  const Vector3 w = motion.angular - rate * shape.pitching;
  const Vector3 v = motion.linear + rate / length * shape.pitching.cross(shape.centre);
  single.wing = &factors.in_single;
  single.pitching_rate = static_cast<float>(rate);
  for (int axis = 0; axis < 3; ++axis) {
    single.pitched_angular[axis] = static_cast<float>(w[axis]);
    single.pitched_linear[axis] = static_cast<float>(v[axis]);
  }
}

inline SingleMotion singleMotion(const ScaledMotion& motion, const LoadSettings& settings,
                                 double reference_length) noexcept {
  const Eigen::Vector3f w = motion.angular.cast<float>();
  const Eigen::Vector3f v = motion.linear.cast<float>();
  const double cosine = settings.separation_cosine;
  return {{w.x(), w.y(), w.z()},
          {v.x(), v.y(), v.z()},
          static_cast<float>(-cosine * std::abs(cosine)),
          static_cast<float>(1 - cosine * cosine),
          static_cast<float>(frictionAtUnitSpeed(settings, motion.unit, reference_length)),
          nullptr,
          settings.law,
          nullptr};
}

/// Converts sums in units of speed [m/s], area [m^2] and length [m] to a load; eq. (15) and (17).
inline Wrench scaledLoad(const LoadSums& sums, double density, double speed, double area,
                         double length) noexcept {
  const double force = -0.5 * density * speed * speed * area;
  const double torque = force * length;
  const double(&s)[6] = sums.wrench;
  return {{torque * s[0], torque * s[1], torque * s[2]},
          {force * s[3], force * s[4], force * s[5]}};
}

namespace {

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
                 (settings.law == PressureLaw::kForm) == (faces.blocks().form != nullptr));
  AMBIENT_ASSERT(!settings.shape || settings.law == PressureLaw::kForm);
  AMBIENT_ASSERT(settings.density >= 0 && reference_length >= 0);
  const double length = faces.lengthUnit();
  const ScaledMotion motion = scaledMotion(relative_twist.angular, relative_twist.linear, length);
  SingleMotion single = singleMotion(motion, settings, reference_length);
  const SingleCut cut = plane ? cutBy(*plane, faces) : SingleCut{};
  if (plane) single.cut = &cut;
  if (settings.shape) addShape(*settings.shape, motion, length, single);
  LoadSums sums = kSumBlocks.fastest()(faces.blocks(), single);
  if (single.wing)
    for (int axis = 0; axis < 3; ++axis)
      sums.wrench[axis] -= settings.shape->shape.pitching[axis] * sums.pitch;
  return scaledLoad(sums, settings.density, motion.unit.speed, faces.areaUnit(), length);
}

}  // namespace ambient
