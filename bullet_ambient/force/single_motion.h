#pragma once

#include <algorithm>
#include <cmath>

#include "bullet_ambient/force/face_loads.h"
#include "bullet_ambient/force/fifth_root.h"
#include "bullet_ambient/force/single_sums.h"

namespace ambient {

/// A motion in units of a length [m] and of a speed that makes all components at most 1, a power of
/// two.
struct ScaledMotion {
  Vector3 angular, linear;
  double speed;  ///< [m/s]
};

inline ScaledMotion scaledMotion(const Vector3& angular, const Vector3& linear,
                                 double length) noexcept {
  const Vector3 turning = length * angular;
  const double largest = std::max(turning.cwiseAbs().maxCoeff(), linear.cwiseAbs().maxCoeff());
  const bool has_size = largest > 0 && std::isfinite(largest);
  const double speed =
      has_size ? std::ldexp(1.0, std::clamp(std::ilogb(largest) + 1, -1000, 1000)) : 1;
  return {turning / speed, linear / speed, speed};
}

inline SingleMotion singleMotion(const ScaledMotion& motion, double cosine) noexcept {
  const Eigen::Vector3f w = motion.angular.cast<float>();
  const Eigen::Vector3f v = motion.linear.cast<float>();
  return {{w.x(), w.y(), w.z()},
          {v.x(), v.y(), v.z()},
          static_cast<float>(-cosine * std::abs(cosine)),
          static_cast<float>(1 - cosine * cosine)};
}

/// Reynolds number of a face that slips with the unit of speed; 0 without friction.
inline double frictionReynolds(const LoadSettings& settings, double speed,
                               double reference_length) noexcept {
  return settings.skin_friction && settings.viscosity > 0
             ? settings.density * speed * reference_length / settings.viscosity
             : 0;
}

/// A wrench from sums in units of length and speed.
inline Wrench scaledWrench(const double (&sums)[6], double factor, double length) noexcept {
  const double turning = factor * length;
  return {{turning * sums[0], turning * sums[1], turning * sums[2]},
          {factor * sums[3], factor * sums[4], factor * sums[5]}};
}

/// Both loads; eq. (15) to (17). `area` is the unit of area [m^2].
inline FaceLoads scaledLoads(const FaceSums& sums, const LoadSettings& settings, double speed,
                             double area, double length, double reynolds) noexcept {
  const double pressure = -0.5 * settings.density * speed * speed * area;
  FaceLoads loads;
  loads.pressure = scaledWrench(sums.pressure, pressure, length);
  if (reynolds > 0)
    loads.friction =
        scaledWrench(sums.friction, pressure * 0.0576 * inverseFifthRoot(reynolds), length);
  return loads;
}

}  // namespace ambient
