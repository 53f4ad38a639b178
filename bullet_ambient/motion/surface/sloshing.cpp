#include "bullet_ambient/motion/surface/sloshing.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/water_kernel.h"

namespace ambient {
namespace {

/// Calls act(mode, e in W, state) for each mode.
template <class States, class Act>
void forEachMode(const SloshingAt& at, States* states, const Act& act) {
  for (std::size_t i = 0; i < at.count; ++i)
    for (const SloshMode& mode : at.modes[i].modes)
      if (mode.volume > 0) act(mode, Vector3(at.to_world * mode.axis), states[i]);
}

/// Returns N: N.x is the velocity of the pivot of a mode for a twist x in B.
Vector6 motionOf(const SloshMode& mode) { return stack(mode.pivot.cross(mode.axis), mode.axis); }

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
  forEachMode(at, states, [&](const SloshMode& mode, const Vector3& axis_W, Sloshing& state) {
    if (!state.is_known) state.velocity_W += motionOf(mode).dot(x) * axis_W;
  });
  forEachMode(at, states,
              [](const SloshMode&, const Vector3&, Sloshing& state) { state.is_known = true; });
}

SloshingEnergy energyOfSloshing(const SloshingAt& at, const Sloshing* states) noexcept {
  SloshingEnergy energy;
  forEachMode(at, states, [&](const SloshMode& mode, const Vector3& axis_W, const Sloshing& state) {
    const double u = axis_W.dot(state.velocity_W), q = axis_W.dot(state.displacement_W);
    const double half_mass = at.density * mode.volume / 2;
    energy.kinetic += half_mass * u * u;
    energy.potential += half_mass * mode.square * q * q;
  });
  return energy;
}

Momentum momentumOfSloshing(const SloshingAt& at, const Sloshing* states) noexcept {
  Vector6 momentum = Vector6::Zero();
  forEachMode(at, states, [&](const SloshMode& mode, const Vector3& axis_W, const Sloshing& state) {
    momentum += at.density * mode.volume * axis_W.dot(state.velocity_W) * motionOf(mode);
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

SloshAlong::SloshAlong(const SloshingAt& at, const SloshMode& of, double damping,
                       const Sloshing& state) noexcept
    : axis_W(at.to_world * of.axis) {
  const double way = axis_W.dot(state.displacement_W);
  mode = {plain(motionOf(of)),
          at.density * of.volume,
          of.square,
          dampingRatio(damping, way, of.farthest),
          way,
          axis_W.dot(state.velocity_W)};
}

Vector6 exchangeSloshing(const SloshingAt& at, const SymmetricMatrix& inverse, double damping,
                         double duration, const Vector6& x, Sloshing* states) noexcept {
  AMBIENT_ASSERT(duration >= 0 && damping >= 0);
  SpatialsOf<double> end = plain(x);
  forEachMode(at, states, [&](const SloshMode& mode, const Vector3&, Sloshing& state) {
    const SloshAlong before(at, mode, damping, state);
    SloshOf<double> slosh = before.mode;
    end = exchangeSlosh<double>(slosh, inverse, duration, end);
    before.move(slosh.way, slosh.velocity, state);
  });
  return asEigen(end);
}

}  // namespace ambient
