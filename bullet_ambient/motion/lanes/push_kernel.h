#pragma once

#include "bullet_ambient/motion/lanes/motion_lanes.h"
#include "bullet_ambient/motion/lanes/passive_kick_kernel.h"
#include "bullet_ambient/motion/lanes/row_lanes.h"
#include "bullet_ambient/motion/lanes/turning_kernel.h"

// Only for sources compiled once per instruction set, see lanes.h.

namespace ambient {
namespace {

/// Sets vectors to zero that are only the rounding of others, as EvenResponse::beyond() does.
inline Vectors withoutRounding(const Vectors& a, const Vectors& of) {
  constexpr double kRounding = 1e-12;
  const Mask is_rounding = dot(a, a) <= kRounding * kRounding * dot(of, of);
  return select(is_rounding, zeroVectors(), a);
}

/// Returns k' - k of docs/theory.md eq. (28b): the response with isotropic added mass to a momentum
/// K k, minus k.
inline Spatials beyondEven(const PushLanes& push, int at, const Pairs& kick) {
  const Vectors& m = kick.momentum.angular;
  Lanes spin[3];
  for (int i = 0; i < 3; ++i) {
    const FlightLane* row = push.even_inverse_inertia[i];
    spin[i] = load(row[0] + at) * m.x + load(row[1] + at) * m.y + load(row[2] + at) * m.z;
  }
  const Spatials even{{spin[0], spin[1], spin[2]},
                      load(push.even_inverse_mass + at) * kick.momentum.linear};
  const Spatials excess = even - kick.twist;
  return {withoutRounding(excess.angular, even.angular),
          withoutRounding(excess.linear, even.linear)};
}

/// Implements FlightKernel::push for the lanes from `at` on.
struct PushStep {
  template <class Matrices>
  static void act(PushLanes& lanes, int at) {
    const FlightLanes& bodies = lanes.bodies;
    const Matrices inertia(bodies.inertia, at), inverse(bodies.inverse_inertia, at);
    const Orientations q = orientationOf(bodies, at);
    const Lanes duration = load(bodies.kick_time + at);
    const Spatials x = load6(bodies.twist_B, at);
    const Pairs motion{x, inertia * x};

    Spatials kick = duration * (inverse * externalWrench(bodies, at, q));
    if (bodies.has_loads) {
      // Equal to dt K^-1 F to first order, but never reverses the motion, for any dt.
      const Spatials load_B = load6(bodies.load_B, at);
      kick = kick + (passiveKick(motion, motion, {inverse * load_B, load_B}, duration).twist - x);
    }
    const Turnings turning = computeTurnings(inertia, inverse, motion, duration);
    const Lanes zero = Lanes{}, rest = 1 - turning.extent;
    const Lanes share = rest < zero ? zero : (rest > all(0.5) ? all(0.5) : rest);
    const Spatials turning_W = toWorld(q, share * turning.change);
    Spatials change_W = turning_W + toWorld(q, kick);
    change_W.linear = change_W.linear + duration * load(lanes.acceleration_W, at);
    store6(lanes.change_W, at, change_W);
    store6(lanes.turning_W, at, turning_W);
    store6(lanes.isotropic_excess_W, at, toWorld(q, beyondEven(lanes, at, {kick, inertia * kick})));
    store(lanes.extent + at, turning.extent);
  }
};

}  // namespace
}  // namespace ambient
