#include "bullet_ambient/motion/links/link_flight.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"

namespace ambient {

namespace {

constexpr double kLargestFactor = 1.5;  // largest factor on a velocity; its inverse is the smallest

bool isModest(double factor) { return factor < kLargestFactor && factor * kLargestFactor > 1; }

}  // namespace

LinkIntegrals::LinkIntegrals(const LinkTree& tree)
    : tree_(tree), flow_(coordinateCount(tree)), x_(flow_), momenta_(flow_) {}

void LinkIntegrals::store(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept {
  AMBIENT_ASSERT(u.size() == flow_.size());
  is_known_ = findFlow(tree_, u, flow_);
  floats_ = !tree_.links[0].keeps_velocity;
  x_ = u - flow_;
  dynamics.momentum(x_, momenta_);
  momentum_ = momenta_.head<6>();
  energy_ = momenta_.dot(x_);
  reference_ = dynamics.position(0);
}

void LinkIntegrals::addForces(LinkDynamics& dynamics, const CoordinatesIn& u, double h) noexcept {
  AMBIENT_ASSERT(h > 0 && u.size() == flow_.size());
  dynamics.appliedForces(momenta_);
  x_ = u - flow_;
  energy_ += 2 * h * momenta_.dot(x_);
  const Vector3 displacement = h / 2 * flow_.segment<3>(3), force = momenta_.segment<3>(3);
  momentum_.head<3>() +=
      h * (momenta_.head<3>() + (dynamics.position(0) - reference_ - displacement).cross(force));
  momentum_.tail<3>() += h * force;
  reference_ += 2 * displacement;
}

Vector6 LinkIntegrals::momentumAbout(const Vector3& point_W) const noexcept {
  Vector6 result = momentum_;
  result.head<3>() += (reference_ - point_W).cross(momentum_.tail<3>());
  return result;
}

double LinkIntegrals::impose(LinkDynamics& dynamics, CoordinatesOut u, bool is_coarse) noexcept {
  if (!is_known_ && !is_coarse) return 0;
  x_ = u - flow_;
  dynamics.momentum(x_, momenta_);
  const double has = momenta_.dot(x_);
  if (is_known_ && floats_) {
    const Vector6 its = momenta_.head<6>(), wanted = momentumAbout(dynamics.position(0));
    dynamics.lockJoints();
    const Vector6 held = dynamics.answerLocked(its), base = dynamics.answerLocked(wanted);
    const double factor =
        std::sqrt((energy_ - wanted.dot(base)) / std::max(0.0, has - its.dot(held)));
    if (isModest(factor)) {
      u = flow_ + factor * x_;
      u.head<6>() += base - factor * held;
      return 0;
    }
  }
  const double factor = std::sqrt(std::max(0.0, energy_) / has);
  if (factor < 1 || (is_known_ && isModest(factor))) u = flow_ + factor * x_;
  return !is_known_ && factor < 1 ? (1 - factor * factor) * has / 2 : 0;
}

void LinkIntegrals::imposeMomentum(LinkDynamics& dynamics, CoordinatesOut u) noexcept {
  if (!is_known_ || !floats_) return;
  x_ = u - flow_;
  dynamics.momentum(x_, momenta_);
  dynamics.lockJoints();
  u.head<6>() += dynamics.answerLocked(momentumAbout(dynamics.position(0)) - momenta_.head<6>());
}

namespace {

constexpr double kLargestTurn = 0.5;  // largest rotation of a link or joint in one substep [rad]
constexpr double kMiddlePrecision = 0.01;  // error at which iterations end, over the tolerance
constexpr double kAcceptedError = 2;    // largest accepted error of a substep, over the tolerance
constexpr double kSubstepSafety = 0.9;  // factor in eq. (25)

TreePose poseOfSize(const LinkTree& tree) {
  TreePose pose;
  pose.joints.resize(tree.size());
  return pose;
}

}  // namespace

LinkFlight::LinkFlight(const LinkTree& tree)
    : tree_(tree),
      dynamics_(tree),
      kick_(tree),
      integrals_(tree),
      mean_(dynamics_.coordinates()),
      end_(dynamics_.coordinates()),
      start_(dynamics_.coordinates()),
      rate_(dynamics_.coordinates()),
      correction_(dynamics_.coordinates()),
      forces_(dynamics_.coordinates()),
      end_pose_(poseOfSize(tree)),
      middle_(poseOfSize(tree)) {}

LinkFlightResult LinkFlight::fly(const TreePose& start, const CoordinatesIn& u, double duration,
                                 const LinkFlightSettings& settings) noexcept {
  AMBIENT_ASSERT(duration > 0 && settings.tolerance > 0 && settings.max_substeps > 0);
  AMBIENT_ASSERT(static_cast<int>(start.joints.size()) == tree_.size() && u.size() == end_.size());
  LinkFlightResult result;
  answers_rows_ = false;
  for (int substeps = 1, wanted = 1;; substeps = wanted) {
    end_pose_ = start;
    end_ = u;
    wanted =
        std::min(flyInSubsteps(substeps, duration, settings, result.count), settings.max_substeps);
    if (wanted <= substeps) break;
  }
  kick_.remember(dynamics_);
  dynamics_.setForces(true);
  mean_ = u;
  velocityBetween(tree_, start, end_pose_, duration, mean_);
  result.is_finite = mean_.allFinite() && end_.allFinite();
  return result;
}

void LinkFlight::stay(const TreePose& pose, const CoordinatesIn& u) noexcept {
  end_pose_ = middle_ = pose;
  mean_ = end_ = u;
  answers_rows_ = false;
}

// Integrates in `substeps` substeps. Returns the number needed; larger means: repeat.
int LinkFlight::flyInSubsteps(int substeps, double duration, const LinkFlightSettings& settings,
                              FlightCount& count) noexcept {
  const double h = duration / substeps;
  const bool has_loads = kick_.hasLoads();
  const bool is_last = substeps >= settings.max_substeps;
  dynamics_.setPose(end_pose_);
  if (has_loads) count += kick_.recall(dynamics_, end_);
  is_stiff_ = has_loads && kick_.isStiff(duration);
  count.coarse = false;
  count.substeps = 0;
  count.error = 0;
  count.energy_removed = 0;
  for (int i = 0; i < substeps; ++i) {
    if (has_loads) kickBy(h / 2, end_);
    integrals_.store(dynamics_, end_);
    const bool converges = findMiddle(h, settings);
    integrals_.addForces(dynamics_, mean_, h);
    movePose(tree_, end_pose_, mean_, h, end_pose_);
    double excess = std::max(converges ? 1.0 : 2.0, std::ceil(h * largestSpin() / kLargestTurn));
    dynamics_.moveTo(end_pose_);
    count.energy_removed += integrals_.impose(dynamics_, end_, is_last && excess > 1);
    double error = excess > 1 ? 1 : 0;  // 1 stands for an unknown error
    if (has_loads) {
      const double by_loads = kickAtEnd(h, count), ratio = by_loads / settings.tolerance;
      error = std::max(error, by_loads);
      if (ratio > kAcceptedError) excess = std::max(excess, std::sqrt(ratio) / kSubstepSafety);
    }
    ++count.substeps;
    if (!(excess > 1)) continue;
    if (!is_last)
      return static_cast<int>(
          std::min<double>(std::ceil(substeps * excess), settings.max_substeps));
    count.coarse = true;
    count.error = std::max(count.error, error);
  }
  return substeps;
}

// Returns the largest spin of links and joints in the middle of a substep [rad/s].
double LinkFlight::largestSpin() const noexcept {
  double spin = 0;
  for (int l = 0; l < tree_.size(); ++l) {
    spin = std::max(spin, dynamics_.twist(l).angular.norm());
    if (l > 0)
      spin = std::max(spin,
                      jointSpin(tree_.links[l].joint, mean_.data() + dynamics_.firstCoordinate(l)));
  }
  return spin;
}

// Computes the middle of a substep h [s] that starts at end_pose_ with end_, eq. (80): mean_
// becomes u_m, end_ becomes u_b. Returns false if the iterations do not converge. @pre dynamics_ is
// at end_pose_
//
// H is factored once, at the start. Its difference to H in the middle is of order h, so that each
// iteration multiplies the error by a factor of order h.
bool LinkFlight::findMiddle(double h, const LinkFlightSettings& settings) noexcept {
  start_ = end_;
  dynamics_.factor();
  dynamics_.accelerations(start_, rate_);
  mean_ = start_ + h / 2 * rate_;
  const double tolerance = settings.tolerance * settings.tolerance;
  double last = h * h / 4 * dynamics_.roughNormSquared(rate_);  // squared size of the last change
  double rest = 0;    // squared size of all further changes, extrapolated
  double motion = 0;  // squared size of the velocity
  for (int i = 0; i < settings.max_iterations; ++i) {
    movePose(tree_, end_pose_, mean_, h / 2, middle_);
    dynamics_.moveTo(middle_);
    dynamics_.correctAccelerations(mean_, rate_);
    correction_ = start_ + h / 2 * rate_ - mean_;
    mean_ += correction_;
    const double change = dynamics_.roughNormSquared(correction_);
    motion = dynamics_.roughNormSquared(mean_) + dynamics_.roughNormSquared(start_);
    rest = last > 0 ? change / last * change : change;
    if (rest <= kMiddlePrecision * kMiddlePrecision * tolerance * motion) break;
    last = change;
  }
  end_ = 2 * mean_ - start_;
  return rest <= tolerance * motion;
}

// Samples the loads at the end of a substep, at the velocity that the last sample predicts, and
// kicks by them for h/2; the next substep begins with the other half. Returns the error of the
// prediction, eq. (25).
double LinkFlight::kickAtEnd(double h, FlightCount& count) noexcept {
  rate_ = end_;
  if (is_stiff_) {
    kickBy(h / 2, rate_);
  } else {
    kick_.foresee(dynamics_, h / 2, rate_);
  }
  count += kick_.sample(dynamics_, rate_);
  kickBy(h / 2, end_);
  return kick_.error(dynamics_, h);
}

// Kicks for h [s] by the loads and, where the fluid is viscous enough to settle a link, by the
// forces; the way between the kicks is then without them.
void LinkFlight::kickBy(double h, Coordinates& u) noexcept {
  if (!is_stiff_) {
    kick_.kick(dynamics_, h, u);
    return;
  }
  dynamics_.setForces(true);
  dynamics_.setVelocity(u);
  dynamics_.appliedForces(forces_);
  dynamics_.setForces(false);
  dynamics_.setVelocity(u);
  dynamics_.appliedForces(start_);
  forces_ -= start_;
  kick_.kick(dynamics_, h, u, &forces_);
}

double LinkFlight::arriveAt(const TreePose& reached, bool has_rows,
                            Coordinates& velocity) noexcept {
  dynamics_.setPose(end_pose_);
  integrals_.store(dynamics_, end_);
  dynamics_.moveTo(reached);
  if (!has_rows) return integrals_.impose(dynamics_, velocity, true);
  integrals_.imposeMomentum(dynamics_, velocity);
  return 0;
}

void LinkFlight::prepareJointRows() noexcept {
  if (answers_rows_) return;
  dynamics_.setPose(middle_);
  dynamics_.factor();
  answers_rows_ = true;
}

LinkFlightResult LinkFlight::computeRowVelocity(const TreePose& start, const CoordinatesIn& u,
                                                double duration) noexcept {
  LinkFlightResult result;
  dynamics_.setPose(start);
  dynamics_.factor();
  dynamics_.accelerations(u, rate_);
  restInFlow(tree_, end_);
  dynamics_.accelerations(end_, mean_);
  mean_ = duration * (rate_ - mean_);
  end_ = u + duration * rate_ - mean_;
  correction_.setZero();
  if (kick_.hasLoads()) {
    correction_ = end_;
    result.count += kick_.sampleForRows(dynamics_, u, duration);
    is_stiff_ = kick_.isStiff(duration);
    if (is_stiff_) end_ = u;  // forces are in the kick
    kickBy(duration, end_);
    correction_ = end_ - correction_;
    dynamics_.setForces(true);
    if (!is_stiff_) dynamics_.factor();  // else rows meet the resistance, too
  }
  result.is_finite = mean_.allFinite() && end_.allFinite();
  return result;
}

}  // namespace ambient
