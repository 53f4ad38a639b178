#pragma once

#include "bullet_ambient/motion/lanes/body_kernel.h"

// Reading of BodyLanes, and steps on them, that several kernels share. For sources that are
// compiled once per instruction set, see spatial_lanes.h.

namespace ambient {
namespace {

inline Orientations orientationOf(const BodyLanes& bodies, int at) {
  return {load(bodies.orientation, at), load(bodies.orientation[3] + at)};
}

/// Returns weight, buoyancy and inertial forces of the flow in B, docs/theory.md eq. (18) and (19).
inline Spatials externalWrench(const BodyLanes& bodies, int at, const Orientations& q) {
  const Vectors buoyancy = q.toBody(load(bodies.buoyancy_W, at));
  return {
      q.toBody(load(bodies.torque_W, at)) + cross(load(bodies.centre_of_volume_B, at), buoyancy),
      q.toBody(load(bodies.force_W, at)) + buoyancy};
}

/// Predicts the motion x after `duration` [s] from guess_B: sample_twist, sample_momentum.
template <class Matrices>
void sampleLoad(FlightLanes& bodies, int at, const Pairs& x, const Lanes& duration) {
  const Spatials guess = load6(bodies.guess_B, at);
  const Matrices inverse(bodies.inverse_inertia, at);
  const Pairs sample = passiveKick(x, x, {inverse * guess, guess}, duration);
  store6(bodies.sample_twist, at, sample.twist);
  store6(bodies.sample_momentum, at, sample.momentum);
}

/// Returns the motion x after `duration` [s] under load_B, which belongs to the sampled motion; eq.
/// (23). Sets load_W, and the error of a kick of kick_time, eq. (25).
template <class Matrices>
Pairs underLoad(FlightLanes& bodies, int at, const Mask& active, const Pairs& x,
                const Lanes& duration) {
  const Matrices inverse(bodies.inverse_inertia, at);
  const Spatials load_B = load6(bodies.load_B, at);
  const Spatials surprise = load_B - load6(bodies.guess_B, at);
  store(bodies.error + at,
        relativeError(x, {inverse * surprise, surprise}, load(bodies.kick_time + at),
                      load(bodies.fall_scale + at)));
  const Spatials load_W = toWorld(orientationOf(bodies, at), load_B);
  store6(bodies.load_W, at, select(active, load_W, load6(bodies.load_W, at)));
  const Pairs sample{load6(bodies.sample_twist, at), load6(bodies.sample_momentum, at)};
  return passiveKick(x, sample, {inverse * load_B, load_B}, duration);
}

}  // namespace
}  // namespace ambient
