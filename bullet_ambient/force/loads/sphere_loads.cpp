#include "bullet_ambient/force/loads/sphere_loads.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/skin_friction.h"

namespace ambient {
namespace {

bool hasFriction(const LoadSettings& settings) noexcept {
  return settings.skin_friction && settings.viscosity > 0;
}

/// Twist in units of V + W, W = R |w|, with the directions e, a, b of SphereIntegrals.
struct SphereMotion {
  double speed;        ///< V + W [m/s]; 0: at rest, or not finite
  Vector3 linear;      ///< v / (V + W)
  Vector3 equatorial;  ///< R w / (V + W)
  Vector3 e, a, b;
  double spin_share, cosine;

  SphereMotion(const Twist& twist, double radius) noexcept {
    linear = twist.linear;
    equatorial = radius * twist.angular;
    const double V = linear.norm(), W = equatorial.norm();
    speed = V + W;
    if (!(speed > 0) || !std::isfinite(speed)) {
      speed = 0;
      return;
    }
    linear /= speed;
    equatorial /= speed;
    const Vector3 spin = W > 0 ? Vector3(equatorial / (W / speed)) : Vector3(Vector3::Zero());
    e = V > 0 ? Vector3(linear / (V / speed)) : spin;  // pure spin: the choice does not matter
    spin_share = W / speed;
    cosine = std::clamp(e.dot(spin), -1.0, 1.0);
    a = spin - cosine * e;
    b = e.cross(spin);
  }

  /// Polar or axial vector from its factors, which the table has for |cosine|. A negative cosine
  /// is mirrored in the plane of e and b.
  Vector3 polar(const Vector3& factors) const noexcept {
    return factors[0] * e + (cosine < 0 ? -factors[1] : factors[1]) * a + factors[2] * b;
  }
  Vector3 axial(const Vector3& factors) const noexcept {
    const double sign = cosine < 0 ? -1 : 1;
    return sign * factors[0] * e + factors[1] * a + sign * factors[2] * b;
  }
};

/// Integral of |t|^2 n over the lee half, in the units of SphereIntegrals; eq. (42).
Vector3 leeHalf(const SphereMotion& motion) noexcept {
  const double spin_along = motion.equatorial.dot(motion.e);
  const Vector3 across = motion.equatorial - spin_along * motion.e;
  const double along =
      motion.linear.squaredNorm() / 2 + spin_along * spin_along / 2 + across.squaredNorm() * 3 / 4;
  return kPi * (4.0 / 3 * motion.linear.cross(motion.equatorial) - along * motion.e +
                0.5 * spin_along * across);
}

}  // namespace

bool needsSphereTable(const LoadSettings& settings) noexcept {
  return settings.separation_cosine != 0 || hasFriction(settings);
}

FaceLoads computeSphereLoads(const SphereTable* table, double radius, double reference_length,
                             const Twist& relative_twist, const LoadSettings& settings) noexcept {
  AMBIENT_ASSERT(radius > 0 && settings.density >= 0);
  FaceLoads loads;
  const bool half = settings.separation_cosine == 0;
  const SphereMotion motion(relative_twist, radius);
  // No load at rest. At alpha = pi/2 pure spin has none either: no normal velocity, no attachment.
  if (motion.speed == 0 || (half && motion.linear.isZero(0))) return loads;
  AMBIENT_ASSERT(table || !needsSphereTable(settings));
  const SphereIntegrals integrals =
      table ? table->at(motion.spin_share, std::abs(motion.cosine)) : SphereIntegrals{};
  const double pressure = 0.5 * settings.density * motion.speed * motion.speed * radius * radius;
  Vector3 detached;
  if (half) {
    detached = leeHalf(motion);
  } else {
    Vector3 factors = integrals.detached;
    factors[0] = std::min(factors[0], 0.0);  // true exactly; interpolation may violate it
    detached = motion.polar(factors);
  }
  const Vector3 everywhere = 8 * kPi / 3 * motion.linear.cross(motion.equatorial);
  loads.pressure.force = pressure * (detached - everywhere);
  if (!hasFriction(settings)) return loads;
  const double reynolds = settings.density * motion.speed * reference_length / settings.viscosity;
  const double friction = -pressure * kFrictionCoefficient * reynoldsPower(reynolds);
  loads.friction.force = friction * motion.polar(integrals.friction_force);
  loads.friction.torque = friction * radius * motion.axial(integrals.friction_torque);
  return loads;
}

}  // namespace ambient
