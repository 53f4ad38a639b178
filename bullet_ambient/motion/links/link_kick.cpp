#include "bullet_ambient/motion/links/link_kick.h"

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

}  // namespace ambient
