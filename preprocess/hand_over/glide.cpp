#include "preprocess/hand_over/glide.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/polar/polar.h"

namespace ambient {
namespace {

using Matrix63 = Eigen::Matrix<double, 6, 3>;

constexpr double kRadian = 180 / kPi;  // [degrees]
constexpr double kGridStep = 0.5;      // of the incidences that are tried first [degrees]

/// A body that moves without turning in the plane of its forward and its upward axis. All in F.
class PlaneFlight {
 public:
  explicit PlaneFlight(const HandedBody& body)
      : body_(body),
        loads_(body.shape, body.settings.medium, {}),
        axes_(body.axes()),
        inertia_(body.ownInertia() + body.added_mass),
        displaced_(body.settings.medium.density * body.wet.volume) {}

  /// Weight less buoyancy over gravity [kg]; negative: the body rises.
  double excess() const { return body_.weight.mass - displaced_; }
  /// The glide at an incidence [rad]; none, if no speed carries the weight.
  std::optional<Glide> glideAt(double incidence) const;
  GlideStability stabilityOf(const Glide& glide) const;

 private:
  Vector3 forward() const { return axes_.col(0); }
  Vector3 left() const { return axes_.col(1); }
  Vector3 up() const { return axes_.col(2); }

  Twist motionAt(double incidence, double speed) const {
    const Vector3 direction(portable::cos(incidence), 0, -portable::sin(incidence));
    return {Vector3::Zero(), axes_ * direction * speed};
  }
  /// Loads of a translation, with Munk's moment.
  Wrench loadAt(const Twist& x) const {
    Wrench load = loads_.at(x).total();
    load.torque += Vector3(inertia_.bottomRightCorner<3, 3>() * x.linear).cross(x.linear);
    return load;
  }
  /// Weight and buoyancy.
  Wrench weightIn(const Vector3& gravity) const {
    const Vector3 arm =
        body_.weight.mass * body_.weight.centre - body_.settings.medium.density * body_.wet.moment;
    return {arm.cross(gravity), excess() * gravity};
  }
  Matrix6 derivativeAt(const Twist& x) const;
  GlideModes modesAmong(const Matrix63& motions, const Vector3& swing, const Glide& glide,
                        const Matrix6& derivative) const;

  const HandedBody& body_;
  BodyLoads loads_;
  Matrix3 axes_;
  Matrix6 inertia_;  // of body and fluid
  double displaced_;
};

// The force grows with some power of the speed between 1 and 2, or a little more: each step halves
// the error of the logarithm at least.
std::optional<Glide> PlaneFlight::glideAt(double incidence) const {
  constexpr int kMostSteps = 100;
  constexpr double kRounding = 1e-14;
  const double weight = std::abs(excess()) * body_.settings.gravity;
  Glide glide;
  glide.incidence = incidence;
  glide.speed = 1;
  Wrench load;
  for (int i = 0; i < kMostSteps; ++i) {
    load = loadAt(motionAt(incidence, glide.speed));
    load.force -= load.force.dot(left()) * left();
    const double factor = std::sqrt(weight / load.force.norm());
    if (!std::isfinite(factor)) return std::nullopt;
    if (std::abs(factor - 1) < kRounding) break;
    glide.speed *= factor;
  }
  const Twist motion = motionAt(incidence, 1);
  const double drag = -load.force.dot(motion.linear);
  const double lift = load.force.dot(motion.linear.cross(left()));
  glide.ratio = (excess() < 0 ? -lift : lift) / drag;
  glide.gravity = -load.force / excess();
  glide.moment = -(load.torque + weightIn(glide.gravity).torque).dot(left());
  glide.angle = std::copysign(portable::atan2(1, glide.ratio), excess());
  constexpr double kVertical = 0.01;  // a dive, whose lift is rounding or that of a crooked mesh
  glide.is_upright = glide.gravity.dot(up()) < kVertical * body_.settings.gravity;
  return glide;
}

// Of the wrench by the twist, about a translation with momentum (l, p) = K x: loads, and of the
// gyroscopic wrench (l x w + p x v, p x w).
Matrix6 PlaneFlight::derivativeAt(const Twist& x) const {
  const Vector6 momentum = inertia_ * x.vector();
  const Matrix3 p = crossMatrix(momentum.tail<3>());
  Matrix6 derivative = -loads_.dampingAt(x);
  derivative.topLeftCorner<3, 3>() += crossMatrix(momentum.head<3>());
  derivative.topRightCorner<3, 3>() += p;
  derivative.bottomLeftCorner<3, 3>() += p;
  derivative.topRows<3>() -= crossMatrix(x.linear) * inertia_.bottomRows<3>();
  return derivative;
}

GlideStability PlaneFlight::stabilityOf(const Glide& glide) const {
  const Twist motion = motionAt(glide.incidence, glide.speed);
  const Matrix6 derivative = derivativeAt(motion);
  // A change of incidence turns the velocity. Its loads have no moment, left, about the point
  // s forward + h up with left.(torque) + s (force up) - h (force forward) = 0.
  const Vector3 turned = motion.linear.cross(left()) * -1;
  const Wrench change = Wrench::fromVector(derivative * stack(Vector3::Zero(), turned));
  const double along = body_.weight.centre.dot(forward()), height = body_.weight.centre.dot(up());
  const double neutral =
      (height * change.force.dot(forward()) - change.torque.dot(left())) / change.force.dot(up());
  GlideStability stability;
  stability.static_margin = along - neutral;
  stability.neutral_point = body_.weight.centre - stability.static_margin * forward();
  const Vector3 none = Vector3::Zero(), ahead = glide.gravity.cross(left()).normalized();
  Matrix63 in_plane, sideways;
  in_plane << left(), none, none, none, forward(), up();
  sideways << forward(), up(), none, none, none, left();
  stability.pitching = modesAmong(in_plane, ahead, glide, derivative);
  stability.sideways = modesAmong(sideways, left(), glide, derivative);
  return stability;
}

// Modes among three unit motions of a mirror-symmetric body, and the change of gravity in its axes
// along `swing` that they make: dg/dt = g x w.
GlideModes PlaneFlight::modesAmong(const Matrix63& motions, const Vector3& swing,
                                   const Glide& glide, const Matrix6& derivative) const {
  Eigen::Matrix<double, 3, 4> wrench;
  wrench << motions.transpose() * derivative * motions,
      motions.transpose() * weightIn(swing).vector();
  const Matrix3 K = motions.transpose() * inertia_ * motions;
  Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
  system.topRows<3>() = K.inverse() * wrench;
  system.bottomLeftCorner<1, 3>() = swing.cross(glide.gravity).transpose() * motions.topRows<3>();
  const Eigen::Vector4cd values = Eigen::EigenSolver<Eigen::Matrix4d>(system, false).eigenvalues();
  GlideModes modes;
  for (const std::complex<double>& value : values) {
    const double size = std::sqrt(std::norm(value));
    if (value.imag() == 0) modes.rates.push_back(value.real());
    if (value.imag() > 0)
      modes.swings.push_back({size, -value.real() / size, 2 * kPi / value.imag()});
  }
  std::sort(modes.rates.begin(), modes.rates.end());
  std::sort(modes.swings.begin(), modes.swings.end(),
            [](const Swing& a, const Swing& b) { return a.frequency > b.frequency; });
  return modes;
}

using Glides = std::vector<std::optional<Glide>>;

Glides glidesOver(const PlaneFlight& flight, double from, double to, int steps) {
  Glides glides;
  for (int i = 0; i <= steps; ++i)
    glides.push_back(flight.glideAt((from + (to - from) * i / steps) / kRadian));
  return glides;
}

/// Halves an interval in which the moment changes its sign.
std::optional<Glide> trimBetween(const PlaneFlight& flight, Glide low, Glide high) {
  constexpr int kHalvings = 60;
  const double moments = std::abs(low.moment) + std::abs(high.moment);
  for (int i = 0; i < kHalvings; ++i) {
    const auto middle = flight.glideAt((low.incidence + high.incidence) / 2);
    if (!middle) return std::nullopt;
    ((middle->moment < 0) == (low.moment < 0) ? low : high) = *middle;
  }
  constexpr double kJump = 1e-6;  // where the moment has one, there is no balance
  const bool is_jump = std::abs(high.moment - low.moment) > kJump * moments;
  return is_jump || !low.is_upright ? std::nullopt : std::optional<Glide>(low);
}

std::optional<Glide> findTrim(const PlaneFlight& flight, const Glides& glides) {
  std::optional<Glide> found;
  bool is_found_stable = false;
  for (std::size_t i = 1; i < glides.size(); ++i) {
    const auto &low = glides[i - 1], &high = glides[i];
    if (!low || !high || (low->moment < 0) == (high->moment < 0)) continue;
    const bool is_stable = high->moment < 0;
    const auto trim = trimBetween(flight, *low, *high);
    if (!trim || (is_found_stable && !is_stable)) continue;
    const bool is_nearer = found && std::abs(trim->incidence) < std::abs(found->incidence);
    if (found && is_stable == is_found_stable && !is_nearer) continue;
    found = trim;
    is_found_stable = is_stable;
  }
  return found;
}

std::optional<Glide> bestOf(const Glides& glides) {
  std::optional<Glide> best;
  for (const auto& glide : glides)
    if (glide && glide->is_upright && (!best || glide->ratio > best->ratio)) best = glide;
  return best;
}

}  // namespace

GlidePlan planGlide(const HandedBody& body) {
  const PlaneFlight flight(body);
  constexpr double kNeutral = 1e-9;
  if (std::abs(flight.excess()) <= kNeutral * body.weight.mass)
    reject(*body.shape, "mass [kg]", body.weight.mass, "other than that of the displaced fluid");
  const double widest = GlidePlan::kWidest;
  const Glides glides =
      glidesOver(flight, -widest, widest, static_cast<int>(2 * widest / kGridStep));
  GlidePlan plan;
  plan.trim = findTrim(flight, glides);
  if (const auto near_best = bestOf(glides)) {
    const double middle = near_best->incidence * kRadian;
    plan.best = bestOf(glidesOver(flight, middle - kGridStep, middle + kGridStep, 20));
  }
  if (plan.trim) plan.stability = flight.stabilityOf(*plan.trim);
  const auto isUp = [](const std::optional<Glide>& glide) { return glide && glide->moment > 0; };
  plan.goes_nose_up = 2 * std::count_if(glides.begin(), glides.end(), isUp) >
                      static_cast<std::ptrdiff_t>(glides.size());
  return plan;
}

}  // namespace ambient
