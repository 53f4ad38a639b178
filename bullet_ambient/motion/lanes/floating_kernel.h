#pragma once

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/motion/lanes/spatial_lanes.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"

// Change of added mass where a body enters or leaves the water, docs/theory.md eq. (66) to (68),
// and waves that floating bodies make, eq. (69) to (72); of one body or of one body per lane, see
// spatial_lanes.h.

namespace ambient {
namespace {

/// Change of the total inertia of a body from one pose to another, and geometry. In B at
/// the second pose; the gradient may be that of the first pose.
template <class Real>
struct AddedMassChangeOf {
  const SymmetricOf<Real>& before;         ///< K_0
  const SymmetricOf<Real>& after;          ///< K_1
  const SymmetricOf<Real>& inverse_after;  ///< K_1^-1
  SpatialsOf<Real> gradient;               ///< F_K of eq. (66), for the twist before [N m, N]
  VectorsOf<Real> normal;                  ///< unit normal of the surface, out of the water
  VectorsOf<Real> centre_of_buoyancy;      ///< [m]
  Real draught, submergence;               ///< MeanDepths [m]
  Real gravity;                            ///< [m/s^2], >= 0
  Real duration;                           ///< [s], > 0
  Real velocity_scale = {};                ///< second term of the denominator of eq. (25) [sqrt(J)]
};

/// Returns theta sigma of eq. (67), the share of the momentum that goes into spray, in [-1, 1].
template <class Real>
inline Real sprayShare(const AddedMassChangeOf<Real>& p, const SpatialsOf<Real>& x) {
  const Real zero = Real{}, one = all<Real>(1);
  const VectorsOf<Real> v = x.linear + cross(x.angular, p.centre_of_buoyancy);
  const Real sinking = zero - dot(p.normal, v), speed = squareRoot(dot(v, v));
  const Real still = sinking * sinking + p.gravity * p.draught;
  const MaskOf<Real> moves = (speed > zero) & (still > zero) & (p.draught > zero);
  const Real open = 1 - 4 * larger(p.submergence, zero) / (moves ? p.draught : one);
  const Real open_share = larger(open < one ? open : one, zero);
  const Real theta = sinking * sinking / (moves ? still : one) * open_share;
  const Real down = 2 * sinking / (moves ? speed : one);
  const Real sigma = larger<Real>(down < one ? down : one, -one);
  return moves ? theta * sigma : zero;
}

/// Returns F_K dt. The force is multiplied by r of eq. (68), so that its work equals the change of
/// the kinetic energy by that of K, if r is between 0 and 3. The torque stays, because it belongs
/// to the gyroscopic terms of the flow. Works at the twist x before the change: of_gradient,
/// F_K . x dt; of_change, half of x . (K_1 - K_0) x [J].
template <class Real>
inline SpatialsOf<Real> gradientImpulse(const AddedMassChangeOf<Real>& p, const Real& of_gradient,
                                        const Real& of_change) {
  constexpr double kMostCorrection = 3;
  const Real ratio = of_change / of_gradient;
  const MaskOf<Real> is_near = (ratio > Real{}) & (ratio < all<Real>(kMostCorrection));
  const Real scale = p.duration * (is_near ? ratio : all<Real>(1));
  return {p.duration * p.gradient.angular, scale * p.gradient.linear};
}

template <class Real>
inline Real largestEntry(const SymmetricOf<Real>& K) {
  Real largest = Real{};
  for (const Real& number : K.entries) largest = larger(larger<Real>(number, -number), largest);
  return largest;
}

/// Twist after the change. The kinetic energy x.K x never grows. Horizontal momentum, and angular
/// momentum about the vertical, are kept unless this bound acts.
template <class Real>
struct AfterChangeOf {
  SpatialsOf<Real> twist;
  Real energy_removed;  ///< by the bound [J]
  Real error;           ///< relative to the motion, eq. (68b) [1]
};

/// Returns eq. (68b): the velocity that F_K of one pose misses, over the motion. `missed_work`:
/// that of the change less that of F_K [J]; `twice_energy`: x . K_0 x.
template <class Real>
inline Real changeError(const AddedMassChangeOf<Real>& p, const Real& missed_work,
                        const Real& spray_share, const Real& twice_energy) {
  const Real norm = squareRoot(twice_energy), scale = norm * (norm + p.velocity_scale);
  const Real missed = (1 - spray_share) * missed_work;
  const MaskOf<Real> moves = scale > Real{};
  return moves ? larger<Real>(missed, -missed) / (moves ? scale : all<Real>(1)) : Real{};
}

/// Computes the twist after the change from the twist x before, eq. (66) to (68): momentum passes
/// between water and body, or into spray. A body whose K has not changed keeps its twist.
template <class Real>
inline AfterChangeOf<Real> applyAddedMassChange(const AddedMassChangeOf<Real>& p,
                                                const SpatialsOf<Real>& x) {
  constexpr double kRounding = 1e-12;
  const Real zero = Real{};
  const SymmetricOf<Real> change = p.after - p.before;
  const MaskOf<Real> changes = largestEntry(change) >= kRounding * largestEntry(p.before);
  const Real of_gradient = p.duration * dot(p.gradient, x), of_change = 0.5 * dot(x, change * x);
  SpatialsOf<Real> impulse = gradientImpulse(p, of_gradient, of_change);
  const Real spray_share = sprayShare(p, x);
  const Real lost = spray_share * larger<Real>(zero - dot(p.normal, impulse.linear), zero);
  impulse = impulse + lost * SpatialsOf<Real>{cross(p.centre_of_buoyancy, p.normal), p.normal};
  const SpatialsOf<Real> momentum = p.before * x;
  const SpatialsOf<Real> end = p.inverse_after * (momentum + impulse);
  const Real allowed2 = dot(x, momentum), energy2 = dot(end, p.after * end);
  const MaskOf<Real> gains = changes & (energy2 > allowed2);
  return {select(changes, scaleWithin(energy2, allowed2) * end, x),
          gains ? 0.5 * (energy2 - allowed2) : zero,
          changes ? changeError<Real>(p, of_change - of_gradient, spray_share, allowed2) : zero};
}

using Modes = FloatingModesOf<Lanes>;

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
inline Lanes clamped(const Lanes& a, double least, double most) {
  return smaller(larger(a, all(least)), all(most));
}
inline Vectors normalized(const Vectors& a) { return 1 / squareRoot(dot(a, a)) * a; }

/// Return logarithm and exponential in the lanes of a mask; 0 elsewhere.
inline Lanes logarithm(const Lanes& x, const Mask& mask) {
  return resultsWhere(mask, portable::log, x, Lanes{});
}
inline Lanes exponential(const Lanes& x, const Mask& mask) {
  return resultsWhere(mask, portable::exp, x, Lanes{});
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

/// Sets motions, stiffness and second moments, to zero without a waterplane. `moment`: first moment
/// S of the wet volume; `s`: normal of the surface; `specific_weight`: rho g.
inline void setRestoring(const Waterplanes& section, const Vectors& moment, const Vectors& s,
                         const Lanes& specific_weight, Modes& modes) {
  const Lanes zero = Lanes{};
  const Mask floats = (section.area > zero) & (specific_weight > zero);
  const Vectors none = zeroVectors(), axis = principalAxis(section, s);
  const Vectors axes[2] = {axis, cross(s, axis)};
  modes.heave = select(floats, Spatials{cross(section.centroid, s), s}, Spatials{none, none});
  modes.stiffness[0] = floats ? specific_weight * section.area : zero;
  const Lanes dipole = dot(s, moment);
  for (int i = 0; i < 2; ++i) {
    const Vectors& across = axes[1 - i];
    const Lanes second = larger(dot(across, section.along(across)), zero);
    modes.tilt[i] = select(floats, axes[i], none);
    modes.second_moment[i] = floats ? second : zero;
    modes.stiffness[i + 1] = floats ? specific_weight * (second + dipole) : zero;
  }
}

/// Sets G, a, b of eq. (69), to zero without a waterplane. @pre setRestoring()
inline void setWaves(const FlotationLanes& flotation, int at, Modes& modes) {
  const Lanes zero = Lanes{}, one = all(1);
  const Mask floats = modes.stiffness[0] > zero;
  const Lanes area = floats ? load(flotation.area + at) : one,
              specific_weight = floats ? load(flotation.specific_weight + at) : one;
  const Lanes length = squareRoot(area), damping = load(flotation.damping + at),
              gravity = load(flotation.gravity + at);
  const Lanes volume = load(flotation.volume + at) + load(flotation.heave_inertia + at);
  const Lanes inverse_depth = clamped(length * area / (floats ? volume : one), 0.1, 8.0);
  Lanes width[2];
  for (int i = 0; i < 2; ++i)
    width[i] = clamped(squareRoot(12 * modes.second_moment[i] / area) / length, 0.2, 5.0);
  const Lanes steep = larger(width[0], width[1]) * inverse_depth;
  const Lanes log_inverse_depth = logarithm(inverse_depth, floats);
  const Lanes log_steepness = logarithm(1 + steep * steep / 30, floats);
  modes.strength[0] = damping * modes.stiffness[0] * 0.075 * inverse_depth * inverse_depth *
                      exponential(-0.63 * log_steepness, floats);
  modes.rate[0] = 0.66 * exponential(0.9 * log_inverse_depth - log_steepness / 3, floats) *
                  squareRoot(gravity / length);
  modes.loss[0] = 1.5 * modes.rate[0];
  for (int i = 0; i < 2; ++i) {
    const Lanes dipole = modes.stiffness[i + 1] / specific_weight;  // V GM
    const Lanes log_width = logarithm(width[i], floats);
    modes.strength[i + 1] = damping * specific_weight * dipole * dipole / (area * area) * 1.14 *
                            exponential(1.2 * log_inverse_depth - 2.6 * log_width, floats);
    const Lanes rate = 2.7 * squareRoot(gravity / (width[i] * length));
    modes.rate[i + 1] = floats ? rate : zero;
    modes.loss[i + 1] = 1.12 * modes.rate[i + 1];
  }
}

/// Returns the square of the largest natural frequency of heave and tilts, each alone [1/s^2].
inline Lanes frequencySquared(const Modes& modes, const SymmetricOf<Lanes>& inertia) {
  const Lanes zero = Lanes{}, one = all(1);
  const Lanes along[3] = {dot(modes.heave, inertia * modes.heave),
                          dot(modes.tilt[0], ofAngular(inertia, modes.tilt[0]).angular),
                          dot(modes.tilt[1], ofAngular(inertia, modes.tilt[1]).angular)};
  Lanes square = zero;
  for (int i = 0; i < 3; ++i) {
    const Mask moves = along[i] > zero;
    square = larger(moves ? modes.stiffness[i] / (moves ? along[i] : one) : zero, square);
  }
  return square;
}

/// Returns K + duration^2/4 sum of k N N^T over the modes with k > 0, docs/theory.md below eq.
/// (68).
template <class Real>
inline SymmetricOf<Real> stiffened(const SymmetricOf<Real>& inertia,
                                   const FloatingModesOf<Real>& modes, const Real& duration) {
  SymmetricOf<Real> K = inertia;
  const auto add = [&](const SpatialsOf<Real>& motion, const Real& stiffness) {
    const Real scale = duration * duration / 4 * larger(stiffness, Real{});
    const Real N[6] = {motion.angular.x, motion.angular.y, motion.angular.z,
                       motion.linear.x,  motion.linear.y,  motion.linear.z};
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) entry(K, i, j) = entry(K, i, j) + scale * N[i] * N[j];
  };
  add(modes.heave, modes.stiffness[0]);
  for (int i = 0; i < 2; ++i) add({modes.tilt[i], VectorsOf<Real>{}}, modes.stiffness[i + 1]);
  return K;
}

template <class Real>
inline Real energyOf(const OscillationOf<Real>& s, const Real& strength) {
  return 0.5 * strength * (s.first * s.first + s.second * s.second);
}

/// Modes of a body at its present pose.
template <class Real>
struct ModesAtPose {
  const FloatingModesOf<Real>& of_body;
  VectorsOf<Real> tilt_W[2];  ///< axes of the tilts in W

  /// Returns the states of a tilt.
  OscillationOf<Real> tiltStates(int i, const WavesOf<Real>& waves) const {
    return {dot(tilt_W[i], waves.tilt_W[0]), dot(tilt_W[i], waves.tilt_W[1])};
  }
  /// Returns the energy of both tilts.
  Real energy(const OscillationOf<Real> (&tilts)[2]) const {
    return energyOf(tilts[0], of_body.strength[1]) + energyOf(tilts[1], of_body.strength[2]);
  }
  /// Stores the states of both tilts as vectors in W, and their energy.
  void setTilts(const OscillationOf<Real> (&tilts)[2], WavesOf<Real>& waves) const {
    waves.tilt_W[0] = tilts[0].first * tilt_W[0] + tilts[1].first * tilt_W[1];
    waves.tilt_W[1] = tilts[0].second * tilt_W[0] + tilts[1].second * tilt_W[1];
    waves.tilt_energy = energy(tilts);
  }
};

/// Scales the waves down where a change of G has raised their energy, eq. (72). Sets them to 0
/// without a waterplane.
template <class Real>
inline void projectOnModes(const ModesAtPose<Real>& modes, WavesOf<Real>& waves) {
  const Real zero = Real{};
  const MaskOf<Real> floats = modes.of_body.rate[0] > zero;
  const Real heave_after = energyOf(waves.heave, modes.of_body.strength[0]);
  const Real by_heave = floats ? scaleWithin(heave_after, waves.heave_energy) : zero;
  waves.heave = {by_heave * waves.heave.first, by_heave * waves.heave.second};
  waves.heave_energy = by_heave * by_heave * heave_after;
  OscillationOf<Real> tilts[2] = {modes.tiltStates(0, waves), modes.tiltStates(1, waves)};
  const Real by_tilt = floats ? scaleWithin(modes.energy(tilts), waves.tilt_energy) : zero;
  for (OscillationOf<Real>& s : tilts) s = {by_tilt * s.first, by_tilt * s.second};
  modes.setTilts(tilts, waves);
}

/// One mode of the waves, for the implicit midpoint rule, eq. (71).
template <class Real>
struct ModeOf {
  const Real &strength, &loss, &rate;
  SpatialsOf<Real> answer;  ///< K^-1 N

  /// Advances the states `s` by `duration` [s] and returns the twist after it. `velocity`: N.x;
  /// `mobility`: N.K^-1 N.
  SpatialsOf<Real> exchange(const SpatialsOf<Real>& x, const Real& velocity, const Real& mobility,
                            const Real& duration, OscillationOf<Real>& s) const {
    const Real half = duration / 2;
    const Real A = 1 + half * loss, B = half * rate, inverse_sum = 1 / (A + B * B);
    const Real stiffness = half * strength * mobility;
    const Real kept =
        inverse_sum * (s.first - B * s.second);  // s_1 in the middle if the body rested
    const Real gain = half * inverse_sum;
    const Real middle = (velocity - stiffness * kept) / (1 + stiffness * gain);
    const Real first = kept + gain * middle, second = s.second + B * first;
    s = {2 * first - s.first, 2 * second - s.second};
    return x - duration * strength * first * answer;
  }
};

/// Applies the waves over `duration` [s], one mode after another, eq. (71). Returns the twist after
/// it. @pre projectOnModes()
template <class Real>
inline SpatialsOf<Real> exchangeWaves(const ModesAtPose<Real>& modes,
                                      const SymmetricOf<Real>& inverse, const Real& duration,
                                      const SpatialsOf<Real>& x, WavesOf<Real>& waves) {
  const FloatingModesOf<Real>& N = modes.of_body;
  const SpatialsOf<Real> answer = inverse * N.heave;
  SpatialsOf<Real> end = ModeOf<Real>{N.strength[0], N.loss[0], N.rate[0], answer}.exchange(
      x, dot(N.heave, x), dot(N.heave, answer), duration, waves.heave);
  waves.heave_energy = energyOf(waves.heave, N.strength[0]);
  OscillationOf<Real> tilts[2];
  for (int i = 0; i < 2; ++i) {
    tilts[i] = modes.tiltStates(i, waves);
    const SpatialsOf<Real> of_tilt = ofAngular(inverse, N.tilt[i]);
    end = ModeOf<Real>{N.strength[i + 1], N.loss[i + 1], N.rate[i + 1], of_tilt}.exchange(
        end, dot(N.tilt[i], end.angular), dot(N.tilt[i], of_tilt.angular), duration, tilts[i]);
  }
  modes.setTilts(tilts, waves);
  return select(N.rate[0] > Real{}, end, x);
}

}  // namespace
}  // namespace ambient
