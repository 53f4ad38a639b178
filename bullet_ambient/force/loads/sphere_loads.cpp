#include "bullet_ambient/force/loads/sphere_loads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>

#include "bullet_ambient/base/ambient_assert.h"
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

namespace {

struct CubicStencil {
  int first;
  double weights[4];
};

// Lagrange's cubic through the four nodes around x, all of them in [begin, end].
CubicStencil stencilAt(double x, int begin, int end) noexcept {
  CubicStencil stencil;
  stencil.first = std::clamp(static_cast<int>(x) - 1, begin, end - 3);
  const double s = x - stencil.first;
  stencil.weights[0] = -(s - 1) * (s - 2) * (s - 3) / 6;
  stencil.weights[1] = s * (s - 2) * (s - 3) / 2;
  stencil.weights[2] = -s * (s - 1) * (s - 3) / 2;
  stencil.weights[3] = s * (s - 1) * (s - 2) / 6;
  return stencil;
}

}  // namespace

SphereTable::SphereTable(double separation_cosine)
    : closing_share_(separation_cosine < 0 ? 1 / (1 - separation_cosine) : 0.5) {
  AMBIENT_ASSERT(separation_cosine >= -1 && separation_cosine <= 0);
  double* node = values_.data();
  for (int i = 0; i < kShares; ++i) {
    for (int j = 0; j < kCosines; ++j, node += kValues) {
      const SphereIntegrals integrals = integrateSphere(shareAt(i), cosineAt(j), separation_cosine);
      int value = 0;
      for (const Vector3* vector :
           {&integrals.detached, &integrals.friction_force, &integrals.friction_torque})
        for (const double factor : *vector) node[value++] = factor;
    }
  }
}

double SphereTable::shareAt(int node) const noexcept {
  const double x = static_cast<double>(node - kMiddle) / kMiddle;
  return closing_share_ + x * std::abs(x) * (x < 0 ? closing_share_ : 1 - closing_share_);
}

double SphereTable::cosineAt(int node) noexcept {
  const double y = static_cast<double>(node) / (kCosines - 1);
  return y * y;
}

SphereIntegrals SphereTable::at(double spin_share, double cosine) const noexcept {
  AMBIENT_ASSERT(spin_share >= 0 && spin_share <= 1 && cosine >= 0 && cosine <= 1);
  const double rest = spin_share - closing_share_;
  const CubicStencil share =
      rest < 0
          ? stencilAt(kMiddle * (1 - std::sqrt(-rest / closing_share_)), 0, kMiddle)
          : stencilAt(kMiddle * (1 + std::sqrt(rest / (1 - closing_share_))), kMiddle, kShares - 1);
  const CubicStencil direction = stencilAt((kCosines - 1) * std::sqrt(cosine), 0, kCosines - 1);
  std::array<double, kValues> sums{};
  for (int i = 0; i < 4; ++i) {
    const double* row =
        values_.data() + ((share.first + i) * kCosines + direction.first) * std::ptrdiff_t{kValues};
    for (int j = 0; j < 4; ++j) {
      const double weight = share.weights[i] * direction.weights[j];
      for (int value = 0; value < kValues; ++value)
        sums[value] += weight * row[j * kValues + value];
    }
  }
  return {{sums[0], sums[1], sums[2]}, {sums[3], sums[4], sums[5]}, {sums[6], sums[7], sums[8]}};
}

std::shared_ptr<const SphereTable> sharedSphereTable(double separation_cosine) {
  static std::mutex mutex;
  static std::map<double, std::shared_ptr<const SphereTable>> tables;
  const std::lock_guard<std::mutex> lock(mutex);
  if (const auto found = tables.find(separation_cosine); found != tables.end())
    return found->second;
  for (auto entry = tables.begin(); entry != tables.end();)
    entry = entry->second.use_count() == 1 ? tables.erase(entry) : std::next(entry);
  return tables[separation_cosine] = std::make_shared<const SphereTable>(separation_cosine);
}

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
