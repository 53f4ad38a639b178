#pragma once

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Waves that floating bodies make, docs/theory.md eq. (69) to (72), one body per lane. For sources
// that are compiled once per instruction set, see spatial_lanes.h.

namespace ambient {
namespace {

/// Motions of FloatingModes of one body per lane: heave and two tilts.
struct Restorings {
  Spatials heave;          ///< N of heave
  Vectors tilt[2];         ///< angular part of N of the tilts; the linear part is 0
  Lanes stiffness[3];      ///< k of heave and tilts
  Lanes second_moment[2];  ///< I_i of the tilts
};

/// G, a, b of eq. (69), (70) for heave and tilts.
struct Waves {
  Lanes strength[3], loss[3], rate[3];
};

/// Waterplane of one body per lane.
struct Waterplanes {
  Lanes area;
  Vectors centroid;
  Lanes spread[6];  ///< second moments xx, yy, zz, xy, xz, yz

  /// Returns the product of the matrix of second moments and a.
  Vectors along(const Vectors& a) const {
    return {spread[0] * a.x + spread[3] * a.y + spread[4] * a.z,
            spread[3] * a.x + spread[1] * a.y + spread[5] * a.z,
            spread[4] * a.x + spread[5] * a.y + spread[2] * a.z};
  }
};

inline Lanes absolute(const Lanes& a) { return larger(a, -a); }
inline Lanes smaller(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
inline Lanes between(const Lanes& a, double least, double most) {
  return smaller(larger(a, all(least)), all(most));
}
inline Vectors normalized(const Vectors& a) { return 1 / squareRoot(dot(a, a)) * a; }

/// Return logarithm and exponential in the lanes of a mask; 0 elsewhere.
inline Lanes logarithm(const Lanes& x, const Mask& mask) {
  Lanes y = Lanes{};
  for (int i = 0; i < kWidth; ++i)
    if (mask[i]) y[i] = portable::log(x[i]);
  return y;
}
inline Lanes exponential(const Lanes& x, const Mask& mask) {
  Lanes y = Lanes{};
  for (int i = 0; i < kWidth; ++i)
    if (mask[i]) y[i] = portable::exp(x[i]);
  return y;
}

/// Returns a unit vector perpendicular to the unit vector n, the one of PlaneAxes::first.
inline Vectors axisAcross(const Vectors& n) {
  const Lanes zero = Lanes{}, x = absolute(n.x), y = absolute(n.y), z = absolute(n.z);
  const Vectors by_z{zero - n.y, n.x, zero}, by_y{n.z, zero, zero - n.x},
      by_x{zero, zero - n.z, n.y};
  const Mask x_is_least = (x <= y) & (x <= z);
  return normalized(select(x_is_least, by_x, select(y <= z, by_y, by_z)));
}

/// Returns a principal axis of the section, perpendicular to s.
inline Vectors principalAxis(const Waterplanes& section, const Vectors& s) {
  const Lanes zero = Lanes{};
  const Vectors e = axisAcross(s), f = cross(s, e);
  const Vectors along = section.along(e);
  const Lanes xx = dot(e, along), xy = dot(f, along), yy = dot(f, section.along(f));
  const Lanes half = 0.5 * (xx - yy), size = squareRoot(half * half + xy * xy);
  // The eigenvector of the larger moment, from the row of the matrix that does not cancel.
  const Lanes lesser = xy < zero ? half - size : size - half;
  const Lanes x = half > zero ? half + size : absolute(xy);
  const Lanes y = half > zero ? xy : lesser;
  const Mask has_axis = size > zero;
  const Vectors axis = select(has_axis, x * e + y * f, e);
  return normalized(axis);
}

/// Returns heave and tilts, zero without a waterplane. `moment`: first moment S of the wet volume;
/// `s`: normal of the surface; `pull`: rho g.
inline Restorings restoringsOf(const Waterplanes& section, const Vectors& moment, const Vectors& s,
                               const Lanes& pull) {
  const Lanes zero = Lanes{};
  const Mask floats = (section.area > zero) & (pull > zero);
  const Vectors none = zeroVectors(), axis = principalAxis(section, s);
  const Vectors axes[2] = {axis, cross(s, axis)};
  Restorings modes;
  modes.heave = select(floats, Spatials{cross(section.centroid, s), s}, Spatials{none, none});
  modes.stiffness[0] = floats ? pull * section.area : zero;
  const Lanes dipole = dot(s, moment);
  for (int i = 0; i < 2; ++i) {
    const Vectors& across = axes[1 - i];
    const Lanes second = larger(dot(across, section.along(across)), zero);
    modes.tilt[i] = select(floats, axes[i], none);
    modes.second_moment[i] = floats ? second : zero;
    modes.stiffness[i + 1] = floats ? pull * (second + dipole) : zero;
  }
  return modes;
}

/// WaveSource of one body per lane.
struct WaveSources {
  Lanes area, volume, heave_inertia, damping, pull, gravity;
};

/// Returns G, a, b of eq. (69); all zero without a waterplane.
inline Waves wavesOf(const WaveSources& source, const Restorings& restoring) {
  const Lanes zero = Lanes{}, one = all(1);
  const Mask floats = restoring.stiffness[0] > zero;
  const Lanes area = floats ? source.area : one, pull = floats ? source.pull : one;
  const Lanes length = squareRoot(area);
  const Lanes volume = source.volume + source.heave_inertia;
  const Lanes per_depth = between(length * area / (floats ? volume : one), 0.1, 8.0);
  Lanes width[2];
  for (int i = 0; i < 2; ++i)
    width[i] = between(squareRoot(12 * restoring.second_moment[i] / area) / length, 0.2, 5.0);
  const Lanes steep = larger(width[0], width[1]) * per_depth;
  const Lanes log_per_depth = logarithm(per_depth, floats);
  const Lanes log_steepness = logarithm(1 + steep * steep / 30, floats);
  Waves waves;
  waves.strength[0] = source.damping * restoring.stiffness[0] * 0.075 * per_depth * per_depth *
                      exponential(-0.63 * log_steepness, floats);
  waves.rate[0] = 0.66 * exponential(0.9 * log_per_depth - log_steepness / 3, floats) *
                  squareRoot(source.gravity / length);
  waves.loss[0] = 1.5 * waves.rate[0];
  for (int i = 0; i < 2; ++i) {
    const Lanes dipole = restoring.stiffness[i + 1] / pull;  // V GM
    const Lanes log_width = logarithm(width[i], floats);
    waves.strength[i + 1] = source.damping * pull * dipole * dipole / (area * area) * 1.14 *
                            exponential(1.2 * log_per_depth - 2.6 * log_width, floats);
    const Lanes rate = 2.7 * squareRoot(source.gravity / (width[i] * length));
    waves.rate[i + 1] = floats ? rate : zero;
    waves.loss[i + 1] = 1.12 * waves.rate[i + 1];
  }
  return waves;
}

/// Returns the square of the largest natural frequency of heave and tilts, each alone [1/s^2].
inline Lanes swingSquared(const Restorings& modes, const FullMatrices& inertia) {
  const Lanes zero = Lanes{}, one = all(1);
  const Lanes along[3] = {dot(modes.heave, inertia * modes.heave),
                          dot(modes.tilt[0], inertia.ofAngular(modes.tilt[0]).angular),
                          dot(modes.tilt[1], inertia.ofAngular(modes.tilt[1]).angular)};
  Lanes square = zero;
  for (int i = 0; i < 3; ++i) {
    const Mask moves = along[i] > zero;
    square = larger(moves ? modes.stiffness[i] / (moves ? along[i] : one) : zero, square);
  }
  return square;
}

/// Returns K + duration^2/4 sum of k N N^T over the modes with k > 0, docs/theory.md below eq.
/// (68).
inline FullMatrices stiffened(const FullMatrices& inertia, const Restorings& modes,
                              const Lanes& duration) {
  const Lanes zero = Lanes{};
  const auto add = [&](FullMatrices& K, const Spatials& motion, const Lanes& stiffness) {
    const Lanes scale = duration * duration / 4 * larger(stiffness, zero);
    const Lanes N[6] = {motion.angular.x, motion.angular.y, motion.angular.z,
                        motion.linear.x,  motion.linear.y,  motion.linear.z};
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) K.entry(i, j) = K.entry(i, j) + scale * N[i] * N[j];
  };
  FullMatrices K = inertia;
  add(K, modes.heave, modes.stiffness[0]);
  for (int i = 0; i < 2; ++i) add(K, {modes.tilt[i], zeroVectors()}, modes.stiffness[i + 1]);
  return K;
}

/// States s_1 and s_2 of one mode, eq. (70).
struct Oscillations {
  Lanes first, second;

  Lanes energy(const Lanes& strength) const {
    return 0.5 * strength * (first * first + second * second);
  }
};

/// WaveMemory of one body per lane.
struct WaveStates {
  Oscillations heave;
  Vectors tilt_W[2];
  Lanes heave_energy, tilt_energy;
};

/// Modes of the bodies at the present pose.
struct WaveModesOfBodies {
  const Restorings& restoring;
  const Waves& waves;
  Vectors tilt_W[2];  ///< axes of the tilts in W
};

/// Returns the states of the tilt about an axis.
inline Oscillations tiltAlong(const WaveStates& waves, const Vectors& axis_W) {
  return {dot(axis_W, waves.tilt_W[0]), dot(axis_W, waves.tilt_W[1])};
}
/// Stores the states of both tilts as vectors in W, and their energy.
inline void setTilt(const WaveModesOfBodies& modes, const Oscillations (&tilt)[2],
                    WaveStates& waves) {
  const Vectors &e1 = modes.tilt_W[0], &e2 = modes.tilt_W[1];
  waves.tilt_W[0] = tilt[0].first * e1 + tilt[1].first * e2;
  waves.tilt_W[1] = tilt[0].second * e1 + tilt[1].second * e2;
  waves.tilt_energy =
      tilt[0].energy(modes.waves.strength[1]) + tilt[1].energy(modes.waves.strength[2]);
}

/// Returns the factor on an amplitude that keeps its energy within the one before.
inline Lanes scaleTo(const Lanes& before, const Lanes& after) {
  const Lanes one = all(1);
  const Mask gains = after > before;
  return gains ? squareRoot(before / (gains ? after : one)) : one;
}

/// Scales the waves down where a change of G has raised their energy, eq. (72). Sets them to 0
/// without a waterplane.
inline void meetModes(const WaveModesOfBodies& modes, WaveStates& waves) {
  const Lanes zero = Lanes{};
  const Mask floats = modes.waves.rate[0] > zero;
  const Lanes heave_after = waves.heave.energy(modes.waves.strength[0]);
  const Lanes by_heave = floats ? scaleTo(waves.heave_energy, heave_after) : zero;
  waves.heave = {by_heave * waves.heave.first, by_heave * waves.heave.second};
  waves.heave_energy = by_heave * by_heave * heave_after;
  Oscillations tilt[2] = {tiltAlong(waves, modes.tilt_W[0]), tiltAlong(waves, modes.tilt_W[1])};
  const Lanes tilt_after =
      tilt[0].energy(modes.waves.strength[1]) + tilt[1].energy(modes.waves.strength[2]);
  const Lanes by_tilt = floats ? scaleTo(waves.tilt_energy, tilt_after) : zero;
  for (Oscillations& s : tilt) s = {by_tilt * s.first, by_tilt * s.second};
  setTilt(modes, tilt, waves);
}

/// One mode of the waves, for the implicit midpoint rule, eq. (71).
struct ModeOfBodies {
  const Lanes &strength, &loss, &rate;
  Spatials answer;  ///< K^-1 N

  /// Advances the states `s` by `duration` [s] and returns the twist after it. `velocity`: N.x;
  /// `per_force`: N.K^-1 N.
  Spatials exchange(const Spatials& x, const Lanes& velocity, const Lanes& per_force,
                    const Lanes& duration, Oscillations& s) const {
    const Lanes half = duration / 2;
    const Lanes A = 1 + half * loss, B = half * rate, per = 1 / (A + B * B);
    const Lanes stiffness = half * strength * per_force;
    const Lanes kept = per * (s.first - B * s.second);  // s_1 in the middle if the body rested
    const Lanes gain = half * per;
    const Lanes middle = (velocity - stiffness * kept) / (1 + stiffness * gain);
    const Lanes first = kept + gain * middle, second = s.second + B * first;
    s = {2 * first - s.first, 2 * second - s.second};
    return x - duration * strength * first * answer;
  }
};

/// Applies the waves over `duration` [s], one mode after another, eq. (71). Returns the twists
/// after it. @pre meetModes()
inline Spatials exchangeWaves(const WaveModesOfBodies& modes, const FullMatrices& inverse,
                              const Lanes& duration, const Spatials& x, WaveStates& waves) {
  const Restorings& N = modes.restoring;
  const Waves& w = modes.waves;
  const Mask floats = w.rate[0] > Lanes{};
  const Spatials answer = inverse * N.heave;
  Spatials end = ModeOfBodies{w.strength[0], w.loss[0], w.rate[0], answer}.exchange(
      x, dot(N.heave, x), dot(N.heave, answer), duration, waves.heave);
  waves.heave_energy = waves.heave.energy(w.strength[0]);
  Oscillations tilt[2];
  for (int i = 0; i < 2; ++i) {
    tilt[i] = tiltAlong(waves, modes.tilt_W[i]);
    const Spatials of_tilt = inverse.ofAngular(N.tilt[i]);
    end = ModeOfBodies{w.strength[i + 1], w.loss[i + 1], w.rate[i + 1], of_tilt}.exchange(
        end, dot(N.tilt[i], end.angular), dot(N.tilt[i], of_tilt.angular), duration, tilt[i]);
  }
  setTilt(modes, tilt, waves);
  return select(floats, end, x);
}

}  // namespace
}  // namespace ambient
