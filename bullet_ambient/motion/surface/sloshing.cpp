#include "bullet_ambient/motion/surface/sloshing.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"

namespace ambient {
namespace {

/// A mode for the motion of the body.
struct Pendulum {
  Vector6 motion;  ///< N: N.x is the velocity of its pivot for a twist x in B
  Vector3 axis_W;
  double mass;       ///< m_1 [kg]
  double stiffness;  ///< m_1 omega^2 [N/m]
};

Pendulum pendulumOf(const SloshingAt& at, const SloshMode& mode) {
  const double mass = at.density * mode.volume;
  return {stack(mode.pivot.cross(mode.axis), mode.axis), at.to_world * mode.axis, mass,
          mass * mode.square};
}

/// Calls act(pendulum, mode, state) for each mode.
template <class States, class Act>
void forEachPendulum(const SloshingAt& at, States* states, const Act& act) {
  for (std::size_t i = 0; i < at.count; ++i)
    for (const SloshMode& mode : at.modes[i].modes)
      if (mode.volume > 0) act(pendulumOf(at, mode), mode, states[i]);
}

/// Damping ratio: that of the settings, and what waves lose that reach floor or top of the hold.
double dampingRatio(double least, double displacement, double farthest) {
  constexpr double kMost = 10;
  const double square = displacement * displacement;
  return square == 0 ? least : least + std::min(kMost, square / (2 * farthest * farthest));
}

}  // namespace

void joinVessel(const SloshingAt& at, const Vector6& x, Sloshing* states) noexcept {
  if (std::all_of(states, states + at.count, [](const Sloshing& state) { return state.is_known; }))
    return;
  for (std::size_t i = 0; i < at.count; ++i)
    if (!states[i].is_known) states[i] = {};
  forEachPendulum(at, states, [&](const Pendulum& pendulum, const SloshMode&, Sloshing& state) {
    if (!state.is_known) state.velocity_W += pendulum.motion.dot(x) * pendulum.axis_W;
  });
  forEachPendulum(at, states, [](const Pendulum&, const SloshMode&, Sloshing& state) {
    state.is_known = true;
  });
}

SloshingEnergy energyOfSloshing(const SloshingAt& at, const Sloshing* states) noexcept {
  SloshingEnergy energy;
  forEachPendulum(at, states,
                  [&](const Pendulum& pendulum, const SloshMode&, const Sloshing& state) {
                    const double u = pendulum.axis_W.dot(state.velocity_W);
                    const double q = pendulum.axis_W.dot(state.displacement_W);
                    energy.kinetic += pendulum.mass * u * u / 2;
                    energy.potential += pendulum.stiffness * q * q / 2;
                  });
  return energy;
}

Momentum momentumOfSloshing(const SloshingAt& at, const Sloshing* states) noexcept {
  Vector6 momentum = Vector6::Zero();
  forEachPendulum(
      at, states, [&](const Pendulum& pendulum, const SloshMode&, const Sloshing& state) {
        momentum += pendulum.mass * pendulum.axis_W.dot(state.velocity_W) * pendulum.motion;
      });
  return {at.to_world * momentum.head<3>(), at.to_world * momentum.tail<3>()};
}

double projectOnModes(const SloshingAt& at, double energy, Sloshing* states) noexcept {
  for (std::size_t i = 0; i < at.count; ++i) {
    const Sloshing before = states[i];
    states[i] = {};
    for (const SloshMode& mode : at.modes[i].modes) {
      if (!(mode.volume > 0)) continue;
      const Vector3 axis_W = at.to_world * mode.axis;
      states[i].is_known = true;
      states[i].displacement_W += axis_W.dot(before.displacement_W) * axis_W;
      states[i].velocity_W += axis_W.dot(before.velocity_W) * axis_W;
    }
  }
  const double after = energyOfSloshing(at, states).sum();
  if (!(after > energy)) return after;
  const double scale = std::sqrt(std::max(0.0, energy) / after);
  for (std::size_t i = 0; i < at.count; ++i) {
    states[i].displacement_W *= scale;
    states[i].velocity_W *= scale;
  }
  return std::max(0.0, energy);
}

Vector6 exchangeSloshing(const SloshingAt& at, const SymmetricMatrix& inverse, double damping,
                         double duration, const Vector6& x, Sloshing* states) noexcept {
  AMBIENT_ASSERT(duration >= 0 && damping >= 0);
  Vector6 end = x;
  const double half = duration / 2;
  forEachPendulum(
      at, states, [&](const Pendulum& pendulum, const SloshMode& mode, Sloshing& state) {
        const Vector6& N = pendulum.motion;
        const double q = pendulum.axis_W.dot(state.displacement_W);
        const double u = pendulum.axis_W.dot(state.velocity_W);
        const double loss =
            2 * dampingRatio(damping, q, mode.farthest) * pendulum.mass * std::sqrt(mode.square);
        const double stiffness = pendulum.stiffness;
        const Vector6 answer = asEigen(inverse * plain(N));
        const double inverse_mass = 1 / pendulum.mass + N.dot(answer);
        const double rate = (u - N.dot(end) - half * inverse_mass * stiffness * q) /
                            (1 + half * inverse_mass * (loss + half * stiffness));
        const double force = stiffness * (q + half * rate) + loss * rate;
        state.displacement_W += duration * rate * pendulum.axis_W;
        state.velocity_W -= duration * force / pendulum.mass * pendulum.axis_W;
        end += duration * force * answer;
      });
  return end;
}

}  // namespace ambient
