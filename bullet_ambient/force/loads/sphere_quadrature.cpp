#include "bullet_ambient/force/loads/sphere_quadrature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/skin_friction.h"

namespace ambient {
namespace {

constexpr int kMeridians = 48;
constexpr int kBrackets = 32;   // intervals of a meridian's lee side searched for separation
constexpr int kBisections = 6;  // followed by a secant step: error 1e-7
/// Gauss's rule of 8 points on [-1, 1]: the positive half of its points.
constexpr double kPoints[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                               0.9602898564975363};
constexpr double kWeights[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                0.1012285362903763};

/// Half meridian of a unit sphere that moves along z; its spin vector lies in the x-z plane.
class Meridian {
 public:
  Meridian(double share, double cosine, double sine, double separation_cosine, double longitude)
      : speed_(1 - share),
        spin_(share * sine, 0, share * cosine),
        cosine_sq_(separation_cosine * separation_cosine),
        along_(portable::cos(longitude), portable::sin(longitude), 0) {}

  Vector3 normal(double angle) const {  // at an angle from the velocity [rad]
    return portable::sin(angle) * along_ + portable::cos(angle) * kZ();
  }

  /// t = -u_s of eq. (12): the tangential part of u.
  Vector3 slip(const Vector3& n) const { return speed_ * (kZ() - n.z() * n) + spin_.cross(n); }

  /// Positive if the lee side is detached at this angle from the velocity, eq. (13).
  double excess(double angle) const {
    const Vector3 n = normal(angle);
    const double normal_speed = speed_ * n.z();
    const double u_sq = slip(n).squaredNorm() + normal_speed * normal_speed;
    return normal_speed * normal_speed - cosine_sq_ * u_sq;
  }

  /// Adds the integrals between two angles from the velocity [rad].
  void add(double from, double to, bool attached, SphereIntegrals& sums) const {
    const double half = (to - from) / 2, middle = (from + to) / 2;
    for (int k = 0; k < 8; ++k) {
      const double side = k < 4 ? -1 : 1;
      const double angle = middle + side * half * kPoints[k % 4];
      const double area = half * kWeights[k % 4] * portable::sin(angle) * (2 * kPi / kMeridians);
      const Vector3 n = normal(angle);
      const Vector3 t = slip(n);
      const double t_sq = t.squaredNorm();
      if (attached) {
        const Vector3 friction = area * t_sq * reynoldsPower(t_sq * t_sq * t_sq) * t;
        sums.friction_force += friction;
        sums.friction_torque += n.cross(friction);
      } else {
        sums.detached += area * t_sq * n;
      }
    }
  }

  /// Returns the angle at which excess() changes sign. @pre one such angle lies between the two
  double edge(double from, double to) const {
    double low = excess(from), high = excess(to);
    for (int i = 0; i < kBisections; ++i) {
      const double middle = (from + to) / 2, value = excess(middle);
      const bool lower = (value > 0) == (low > 0);
      (lower ? from : to) = middle;
      (lower ? low : high) = value;
    }
    return from + (to - from) * low / (low - high);
  }

 private:
  static Vector3 kZ() { return Vector3::UnitZ(); }

  double speed_;
  Vector3 spin_;
  double cosine_sq_;
  Vector3 along_;
};

void addLeeSide(const Meridian& meridian, SphereIntegrals& sums) {
  double begin = kPi / 2, from = begin, value = meridian.excess(from);
  for (int bracket = 1; bracket <= kBrackets; ++bracket) {
    const double to = kPi / 2 * (1 + static_cast<double>(bracket) / kBrackets);
    const double next = meridian.excess(to);
    if ((next > 0) != (value > 0)) {
      const double edge = meridian.edge(from, to);
      meridian.add(begin, edge, !(value > 0), sums);
      begin = edge;
    }
    from = to;
    value = next;
  }
  meridian.add(begin, kPi, !(value > 0), sums);
}

}  // namespace

SphereIntegrals integrateSphere(double spin_share, double cosine,
                                double separation_cosine) noexcept {
  // Spin along the velocity leaves direction a undefined; a sine of 1e-3 gives the limit to 1e-6.
  const double sine = std::max(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 1e-3);
  SphereIntegrals sums{Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  for (int i = 0; i < kMeridians; ++i) {
    const Meridian meridian(spin_share, cosine, sine, separation_cosine,
                            2 * kPi * (i + 0.5) / kMeridians);
    meridian.add(0, kPi / 2, true, sums);
    if (separation_cosine < 0) {
      addLeeSide(meridian, sums);
    } else {
      meridian.add(kPi / 2, kPi, false, sums);
    }
  }
  for (Vector3* sum : {&sums.detached, &sums.friction_force, &sums.friction_torque})
    *sum = Vector3(sum->z(), sum->x() / sine, sum->y() / sine);
  return sums;
}

}  // namespace ambient
