#pragma once

#include <type_traits>

#include "bullet_ambient/motion/lanes/body_kernel.h"

// Reading of BodyLanes, and steps on them, that several kernels share. For sources that are
// compiled once per instruction set, see spatial_lanes.h.

namespace ambient {
namespace {

/// Returns weight, buoyancy and inertial forces of the flow in B, docs/theory.md eq. (18) and (19).
inline Spatials externalWrench(const BodyLanes& bodies, int at, const Orientations& q) {
  const Vectors buoyancy = q.toBody(load(bodies.buoyancy_W, at));
  return {
      q.toBody(load(bodies.torque_W, at)) + cross(load(bodies.centre_of_volume_B, at), buoyancy),
      q.toBody(load(bodies.force_W, at)) + buoyancy};
}

/// Returns the wrench in B that the turn of a body is to a velocity that stays in W, (2) and K (0,
/// w x v): of Munk's moment and of the gyroscope.
template <class Matrices>
Spatials turningWrench(const Matrices& inertia, const Pairs& x) {
  return gyroscopic(x) + inertia * Spatials{zeroVectors(), cross(x.twist.angular, x.twist.linear)};
}

/// Returns the bodies that the fluid stops in less time than it takes them to turn, eq. (124).
/// `turning`: result of turningWrench() at the motion x.
template <class Matrices>
Mask settledOf(const BodyLanes& bodies, int at, const Pairs& x, const Spatials& turning) {
  constexpr double kTimes = 2;
  const Lanes rate = load(bodies.settling + at), square = rate * rate;
  const Pairs turn{Matrices(bodies.inverse_inertia, at) * turning, turning};
  const Lanes most = kTimes * kTimes * inner(turn, turn);
  const Lanes spin = kTimes * kTimes * dot(x.twist.angular, x.twist.angular);
  return (rate > Lanes{}) & (most <= square * inner(x, x)) & (spin <= square);
}

/// Bodies of a register that have a resistance.
inline Mask viscousOf(const BodyLanes& bodies, int at) {
  return load(bodies.growth[1] + at) > Lanes{};
}

/// Sets C of the last load as Resistance::grown() does, with its bits: mu R in the scale of the
/// growth, brought to the centre of mass.
template <class Matrices>
void growResistance(BodyLanes& bodies, int at) {
  if (!bodies.has_resistance) return;
  const Lanes roots[2] = {load(bodies.growth[0] + at), load(bodies.growth[1] + at)};
  const auto there = [&](int i, int j) {
    return roots[i / 3] * load(bodies.resistance_there[i][j] + at) * roots[j / 3];
  };
  const auto set = [&](int i, int j, const Lanes& entry) {
    store(bodies.resistance[symmetricEntry(i, j)] + at, entry);
  };
  if constexpr (std::is_same_v<Matrices, DiagonalMatrices>) {
    for (int i = 0; i < 6; ++i) set(i, i, there(i, i));
  } else {
    Lanes d[3], right[6][3];  // way to the centre of mass, right columns of C there
    for (int j = 0; j < 3; ++j) {
      d[j] = -load(bodies.centre_of_reaction[j] + at);
      for (int i = 0; i < 6; ++i) right[i][j] = there(i, 3 + j);
    }
    for (int j = 0; j < 3; ++j) {
      const int k = (j + 1) % 3, l = (j + 2) % 3;
      const auto turned = [&](int i) { return right[i][k] * d[l] - right[i][l] * d[k]; };
      const Lanes below[3] = {there(3, j) + turned(3), there(4, j) + turned(4),
                              there(5, j) + turned(5)};
      for (int i = 0; i < 3; ++i) {
        const int p = (i + 1) % 3, q = (i + 2) % 3;
        set(i, 3 + j, right[i][j] + (right[3 + p][j] * d[q] - right[3 + q][j] * d[p]));
        if (i > j) continue;
        set(i, j, there(i, j) + (turned(i) + (below[p] * d[q] - below[q] * d[p])));
        set(3 + i, 3 + j, right[3 + i][j]);
      }
    }
  }
}

/// Calls act(Settling or DiagonalSettling) for K and C of the bodies.
template <class Matrices, class Act>
auto withResistance(const BodyLanes& bodies, int at, const Act& act) {
  const Matrices inertia(bodies.inertia, at), inverse(bodies.inverse_inertia, at),
      resistance(bodies.resistance, at);
  return act(settlingOf(inertia, inverse, resistance));
}

/// Returns viscous() for the bodies with a resistance, ideal() for others; of both only what is
/// needed. With `is_met` false ideal() for all.
template <class Ideal, class Viscous>
Pairs whereViscous(const BodyLanes& bodies, int at, bool is_met, const Ideal& ideal,
                   const Viscous& viscous) {
  if (!is_met || !bodies.has_resistance) return ideal();
  const Mask mask = viscousOf(bodies, at);
  if (!anyOf(~mask)) return viscous();
  if (!anyOf(mask)) return ideal();
  return select(mask, viscous(), ideal());
}

/// Returns x.C x over x.K x of a motion [1/s]: what a load has changed decays at this rate.
template <class Matrices>
Lanes settlingRate(const BodyLanes& bodies, int at, const Pairs& x) {
  const Lanes zero = Lanes{}, energy = inner(x, x);
  const Lanes drag = dot(x.twist, Matrices(bodies.resistance, at) * x.twist);
  const Mask is_met = viscousOf(bodies, at) & (energy > zero);
  return is_met ? drag / (is_met ? energy : all(1)) : zero;
}

/// Predicts the motion x in the middle of a kick from predicted_load_B: sample_twist,
/// sample_momentum. `duration` [s]: half of the kick. Bodies with a resistance fall on the way.
template <class Matrices>
void sampleLoad(FlightLanes& bodies, int at, const Pairs& x, const Lanes& duration, bool falls) {
  const Spatials predicted = load6(bodies.predicted_load_B, at);
  const Matrices inverse(bodies.inverse_inertia, at);
  const Pairs response{inverse * predicted, predicted};
  const Pairs sample = whereViscous(
      bodies, at, falls, [&] { return passiveKick(x, x, response, duration); },
      [&] {
        const Pairs fall{load6(bodies.gravity_twist, at), load6(bodies.gravity_momentum, at)};
        return withResistance<Matrices>(bodies, at, [&](const auto& terms) {
          return viscousSample<Lanes>(x, response, fall, terms, 2 * duration);
        });
      });
  store6(bodies.sample_twist, at, sample.twist);
  store6(bodies.sample_momentum, at, sample.momentum);
}

/// Returns the motion x after `duration` [s] under load_B, which belongs to the sampled motion; eq.
/// (23). Sets load_W, and the error of a kick of kick_time, eq. (25). With `falls`, bodies with a
/// resistance meet it, and fall, on the way: eq. (122).
template <class Matrices>
Pairs underLoad(FlightLanes& bodies, int at, const Mask& active, const Pairs& x,
                const Lanes& duration, bool falls) {
  const Matrices inverse(bodies.inverse_inertia, at);
  const Spatials load_B = load6(bodies.load_B, at);
  const Spatials load_error = load_B - load6(bodies.predicted_load_B, at);
  const Lanes time = load(bodies.kick_time + at);
  const Pairs sampled{load6(bodies.sample_twist, at), load6(bodies.sample_momentum, at)};
  Lanes error =
      relativeError(x, {inverse * load_error, load_error}, time, load(bodies.velocity_scale + at));
  if (bodies.has_resistance)
    error = error / (1 + time * settlingRate<Matrices>(bodies, at, sampled));
  store(bodies.error + at, error);
  const Spatials load_W = toWorld(loadOrientation(bodies.orientation, at), load_B);
  store6(bodies.load_W, at, select(active, load_W, load6(bodies.load_W, at)));
  const Pairs response{inverse * load_B, load_B};
  return whereViscous(
      bodies, at, falls, [&] { return passiveKick(x, sampled, response, duration); },
      [&] {
        const Pairs fall{load6(bodies.gravity_twist, at), load6(bodies.gravity_momentum, at)};
        return withResistance<Matrices>(bodies, at, [&](const auto& terms) {
          return viscousKick<Lanes>(x, sampled, response, fall, terms, duration);
        });
      });
}

/// Returns a bound of t A, A = K^-1 C, for a duration t [s]: its trace.
inline Lanes settlingBound(const FullMatrices& inverse, const FullMatrices& resistance,
                           const Lanes& duration) {
  Lanes diagonal = Lanes{}, rest = Lanes{};
  for (int i = 0; i < 6; ++i) {
    diagonal = diagonal + entry(inverse, i, i) * entry(resistance, i, i);
    for (int j = i + 1; j < 6; ++j) rest = rest + entry(inverse, i, j) * entry(resistance, i, j);
  }
  return duration * (diagonal + 2 * rest);
}

/// Returns the motion x after `duration` t [s] under the resistance alone, V of eq. (120) without f
/// and q. Where t A is small, its series 1 - tA + (tA)^2/2 - (tA)^4/4 + (tA)^5/4 - ... costs a
/// third of the solution; what is left out is below rounding.
inline Pairs underResistance(const FlightLanes& bodies, int at, const Pairs& x,
                             const Lanes& duration) {
  if (!bodies.has_resistance) return x;
  constexpr double kSmall = 2.5e-3;
  static constexpr double kSeries[] = {-1, 0.5, 0, -0.25, 0.25};
  const FullMatrices inverse(bodies.inverse_inertia, at), resistance(bodies.resistance, at);
  const Mask is_viscous = viscousOf(bodies, at),
             is_small = settlingBound(inverse, resistance, duration) < all(kSmall);
  Pairs result = x;
  if (anyOf(is_viscous & is_small)) {
    Pairs power = x;  // (tA)^n x
    for (const double c : kSeries) {
      const Spatials drag = duration * (resistance * power.twist);
      power = {inverse * drag, drag};
      result = result + all(c) * power;
    }
  }
  if (anyOf(is_viscous & ~is_small)) {
    const Pairs settled = withResistance<FullMatrices>(bodies, at, [&](const auto& terms) {
      return settle<Lanes>(x.momentum, terms, Lanes{}, duration);
    });
    result = select(is_small, result, settled);
  }
  return select(is_viscous, result, x);
}

}  // namespace
}  // namespace ambient
