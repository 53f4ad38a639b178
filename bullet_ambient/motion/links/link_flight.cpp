#include "bullet_ambient/motion/links/link_flight.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

namespace {

bool isLoaded(const Link& link) { return link.model && link.model->loads; }

SurfaceLoad evaluate(const Link& link, const Twist& relative_twist, FlightCount& count) {
  const SurfaceLoad load = computeSurfaceLoad(*link.model, relative_twist, link.surroundings);
  ++count.load_evaluations;
  count.guarded += load.guarded;
  return load;
}

}  // namespace

LinkKick::LinkKick(const LinkTree& tree)
    : tree_(tree),
      samples_(tree.size()),
      drags_(tree.size(), 0.0),
      drag_impulses_(tree.size()),
      lift_impulses_(tree.size()),
      load_errors_(tree.size()),
      resistances_(tree.size()),
      change_(coordinateCount(tree)),
      flow_(coordinateCount(tree)) {}

bool LinkKick::hasLoads() const noexcept {
  return std::any_of(tree_.links.begin(), tree_.links.end(), isLoaded);
}

Wrench LinkKick::Sample::at(const Wrench& momentum, double its_speed) const {
  if (!(speed > 0)) return {};
  const double ratio = its_speed / speed;
  return -drag * ratio * momentum + ratio * ratio * lift;
}

// Stores load_on(index of the link, its relative twist) of all links that have loads.
template <class LoadOn>
void LinkKick::sampleAll(LinkDynamics& dynamics, const CoordinatesIn& u,
                         const LoadOn& load_on) noexcept {
  dynamics.setVelocity(u);
  dynamics.measure();
  has_resistance_ = false;
  for (int l = 0; l < tree_.size(); ++l) {
    Sample& sample = samples_[l];
    const Sample last = sample;
    sample = {};
    resistances_[l] = {};
    const Link& link = tree_.links[l];
    if (!isLoaded(link)) continue;
    const Twist y = dynamics.relativeTwist(l);
    const SurfaceLoad found = load_on(l, y);
    const Wrench& load = found.wrench;
    if (link.model->resistance && found.growth.translation > 0) {
      sample.growth = found.growth;
      sample.settling = found.growth.translation * found.growth.translation * link.model->settling;
      resistances_[l] = blocksOf(link.model->resistance->grown(found.growth));
      has_resistance_ = true;
    }
    const Wrench momentum = dynamics.relativeMomentum(l);
    const double energy = dynamics.relativeEnergy(l);
    if (!(energy > 0)) continue;
    const double along = power(load, y) / energy;
    sample = {std::max(0.0, -along), std::sqrt(energy), load + -along * momentum, load,
              sample.growth,         sample.settling};
    load_errors_[l] = load;
    load_errors_[l] -= last.at(momentum, sample.speed);
  }
}

FlightCount LinkKick::sample(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept {
  FlightCount count;
  sampleAll(dynamics, u, [&](int l, const Twist& y) { return evaluate(tree_.links[l], y, count); });
  return count;
}

FlightCount LinkKick::sampleForRows(LinkDynamics& dynamics, const CoordinatesIn& u,
                                    double h) noexcept {
  const FlightCount count = sample(dynamics, u);
  for (int l = 0; l < tree_.size(); ++l) {
    const Link& link = tree_.links[l];
    if (!isLoaded(link) || !turnsWithFluid(link.surroundings)) continue;
    const Wrench load = samples_[l].load;
    samples_[l] = {0, 0, {}, {}, samples_[l].growth, samples_[l].settling};
    samples_[l].load = meanLoadInTurningFluid({*link.model, link.surroundings, {}, h}, *link.model,
                                              dynamics.relativeTwist(l), load);
  }
  return count;
}

FlightCount LinkKick::recall(LinkDynamics& dynamics, const CoordinatesIn& u) noexcept {
  FlightCount count;
  sampleAll(dynamics, u, [&](int l, const Twist& y) -> SurfaceLoad {
    const FlightMemory* memory = tree_.links[l].memory;
    if (!memory || !memory->has_load) return evaluate(tree_.links[l], y, count);
    const Matrix3 to_link = dynamics.rotation(l).transpose();
    return {turned(to_link, memory->load_W), false, memory->growth};
  });
  return count;
}

void LinkKick::remember(const LinkDynamics& dynamics) const noexcept {
  for (int l = 0; l < tree_.size(); ++l) {
    const Link& link = tree_.links[l];
    if (!link.memory || !isLoaded(link)) continue;
    link.memory->load_W = turned(dynamics.rotation(l), samples_[l].load);
    link.memory->growth = samples_[l].growth;
    link.memory->has_load = true;
  }
}

double LinkKick::error(LinkDynamics& dynamics, double h) noexcept {
  AMBIENT_ASSERT(h > 0);
  double motion = 0;
  for (int l = 0; l < tree_.size(); ++l) {
    if (!isLoaded(tree_.links[l])) {
      load_errors_[l] = {};
      continue;
    }
    const Link& link = tree_.links[l];
    const double fall = velocityScale({*link.model, link.surroundings, {}, h});
    motion += samples_[l].speed * samples_[l].speed + fall * fall;
  }
  dynamics.respond(load_errors_, change_);
  return motion > 0 ? h * std::sqrt(dynamics.normSquared(change_) / motion) : 0;
}

bool LinkKick::isStiff(double h) const noexcept {
  for (int l = 0; l < tree_.size(); ++l) {
    const Link& link = tree_.links[l];
    if (isLoaded(link) && settlingIn(*link.model, samples_[l].growth, h) > 0) return true;
  }
  return false;
}

void LinkKick::kick(LinkDynamics& dynamics, double h, CoordinatesOut u,
                    const Coordinates* force) noexcept {
  AMBIENT_ASSERT(h > 0 && u.size() == change_.size());
  dynamics.setVelocity(u);
  dynamics.measure();
  for (int l = 0; l < tree_.size(); ++l) {
    const Sample& sample = samples_[l];
    drags_[l] = 0;
    drag_impulses_[l] = h * sample.load;
    lift_impulses_[l] = {};
    if (sample.speed > 0) {
      const Wrench momentum = dynamics.relativeMomentum(l);
      const double ratio = std::sqrt(dynamics.relativeEnergy(l)) / sample.speed;
      drags_[l] = h * ratio * sample.drag;
      drag_impulses_[l] = -drags_[l] * momentum;
      lift_impulses_[l] = h * ratio * ratio * sample.lift;
    }
    if (sample.growth.translation > 0)
      drag_impulses_[l] -= h * product(resistances_[l], dynamics.relativeTwist(l));
  }
  const KickTerms terms{drags_.data(), has_resistance_ ? resistances_.data() : nullptr, h};
  dynamics.factor(&terms);
  dynamics.respond(drag_impulses_, change_);
  u += change_;
  if (force) {
    dynamics.respond(*force, change_);
    u += h * change_;
  }
  applyLift(dynamics, u);
}

void LinkKick::foresee(LinkDynamics& dynamics, double h, CoordinatesOut u) noexcept {
  AMBIENT_ASSERT(h > 0 && u.size() == change_.size());
  dynamics.setVelocity(u);
  dynamics.measure();
  for (int l = 0; l < tree_.size(); ++l) {
    const Sample& sample = samples_[l];
    drag_impulses_[l] = {};
    if (!(sample.speed > 0)) continue;
    const double ratio = std::sqrt(dynamics.relativeEnergy(l)) / sample.speed;
    const double drag = h * (ratio * sample.drag + sample.settling), left = 1 / (1 + drag),
                 speed = ratio * left;
    drag_impulses_[l] =
        -drag * left * dynamics.relativeMomentum(l) + h * speed * speed * sample.lift;
  }
  dynamics.respond(drag_impulses_, change_);
  u += change_;
}

// Adds the velocity change by lift. Lift does no work: if all links are in one flow, `u` is scaled
// so that the energy relative to the flow does not grow. Otherwise the change is shortened by (1 +
// theta^2)^(-1/2), docs/theory.md below eq. (81).
void LinkKick::applyLift(LinkDynamics& dynamics, CoordinatesOut u) noexcept {
  dynamics.respond(lift_impulses_, change_);
  if (findFlow(tree_, u, flow_)) {
    u -= flow_;
    const double before = dynamics.normSquared(u);
    u += change_;
    const double after = dynamics.normSquared(u);
    if (after > before) u *= std::sqrt(before / after);
    u += flow_;
    return;
  }
  const double lift = dynamics.normSquared(change_);
  dynamics.setVelocity(u);
  dynamics.measure();
  double motion = 0;
  for (int l = 0; l < tree_.size(); ++l) motion += dynamics.relativeEnergy(l);
  if (motion > 0) u += change_ / std::sqrt(1 + lift / motion);
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
