#include "bullet_ambient/motion/body_waves.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/spatial/elementary.h"

namespace ambient {
namespace {

/// Two states of one mode.
struct Oscillation {
  double first, second;

  double energy(const WaveMode& mode) const {
    return 0.5 * mode.strength * (first * first + second * second);
  }
};

// Of energies, after what has changed.
double scaleTo(double before, double after) {
  return after > before ? std::sqrt(before / after) : 1;
}

Oscillation tiltAlong(const WaveMemory& waves, const Vector3& axis_W) {
  return {axis_W.dot(waves.tilt_W[0]), axis_W.dot(waves.tilt_W[1])};
}

Vector3 axisOf(const WaveMode& mode, const Matrix3& to_world) {
  return to_world * mode.motion.head<3>();
}

void setTilt(const WaveModes& modes, const Matrix3& to_world, const Oscillation (&tilt)[2],
             WaveMemory& waves) {
  const Vector3 e1 = axisOf(modes.tilt[0], to_world), e2 = axisOf(modes.tilt[1], to_world);
  waves.tilt_W[0] = tilt[0].first * e1 + tilt[1].first * e2;
  waves.tilt_W[1] = tilt[0].second * e1 + tilt[1].second * e2;
  waves.tilt_energy = tilt[0].energy(modes.tilt[0]) + tilt[1].energy(modes.tilt[1]);
}

/// The implicit midpoint rule for one mode and the body, eq. (71).
Vector6 exchangeMode(const WaveMode& mode, const Matrix6& inverse_inertia, double duration,
                     const Vector6& x, Oscillation& s) {
  const double half = duration / 2;
  const double A = 1 + half * mode.loss, B = half * mode.rate, per = 1 / (A + B * B);
  const Vector6 answer = inverse_inertia * mode.motion;
  const double stiffness = half * mode.strength * mode.motion.dot(answer);
  const double kept = per * (s.first - B * s.second);  // of s_1 in the middle, without the body
  const double gain = half * per;
  const double velocity =
      (mode.motion.dot(x) - stiffness * kept) / (1 + stiffness * gain);  // in the middle
  const double first = kept + gain * velocity, second = s.second + B * first;
  s = {2 * first - s.first, 2 * second - s.second};
  return x - duration * mode.strength * first * answer;
}

/// Of a symmetric tensor across s.
Vector3 principalAxis(const Matrix3& tensor, const Vector3& s) {
  const PlaneAxes e(s);
  const Vector3 along = tensor * e.first;
  const double xx = e.first.dot(along), xy = e.second.dot(along);
  const double yy = e.second.dot(tensor * e.second);
  const double half = 0.5 * (xx - yy), size = std::sqrt(half * half + xy * xy);
  if (!(size > 0)) return e.first;
  // The eigenvector of the larger moment, from the row of the matrix that does not cancel.
  const double x = half > 0 ? half + size : std::abs(xy);
  const double y = half > 0 ? xy : std::copysign(size - half, xy);
  return (x * e.first + y * e.second).normalized();
}

struct Scales {
  double length;     ///< L [m]
  double per_depth;  ///< L/d
  double width[2];   ///< B_i / L
  double steepness;  ///< q
};

Scales scalesOf(const WaveSource& source, const RestoringModes& restoring) {
  const double area = source.wet.waterplane.area;
  Scales k;
  k.length = std::sqrt(area);
  const double depth = (source.wet.volume + source.heave_inertia) / area;
  k.per_depth = std::clamp(k.length / depth, 0.1, 8.0);
  for (std::size_t i = 0; i < 2; ++i)
    k.width[i] =
        std::clamp(std::sqrt(12 * restoring[i + 1].second_moment / area) / k.length, 0.2, 5.0);
  const double steep = std::max(k.width[0], k.width[1]) * k.per_depth;
  k.steepness = 1 + steep * steep / 30;
  return k;
}

}  // namespace

RestoringModes restoringModesOf(const WetVolume& wet, const SurfacePlane& surface) noexcept {
  const Waterplane& plane = wet.waterplane;
  const double pull = surface.density * surface.gravity;
  if (!(plane.area > 0) || !(pull > 0)) return {};
  const Vector3& s = surface.normal;
  const Vector3 axis = principalAxis(plane.spread, s);
  const Vector3 axes[2] = {axis, s.cross(axis)};
  RestoringModes modes;
  modes[0] = {stack(plane.centroid.cross(s), s), pull * plane.area, 0};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector3& across = axes[1 - i];
    const double moment = std::max(0.0, across.dot(plane.spread * across));
    modes[i + 1] = {stack(axes[i], Vector3::Zero()), pull * (moment + s.dot(wet.moment)), moment};
  }
  return modes;
}

WaveModes waveModesOf(const WaveSource& source, const RestoringModes& restoring) noexcept {
  if (!(restoring[0].stiffness > 0)) return {};
  const Scales k = scalesOf(source, restoring);
  const double area = source.wet.waterplane.area, gravity = source.plane.gravity;
  const double pull = source.plane.density * gravity;
  const double log_per_depth = portable::log(k.per_depth);
  const double log_steepness = portable::log(k.steepness);
  WaveModes modes;
  modes.heave.motion = restoring[0].motion;
  modes.heave.strength = source.damping * restoring[0].stiffness * 0.075 * k.per_depth *
                         k.per_depth * portable::exp(-0.63 * log_steepness);
  modes.heave.rate =
      0.66 * portable::exp(0.9 * log_per_depth - log_steepness / 3) * std::sqrt(gravity / k.length);
  modes.heave.loss = 1.5 * modes.heave.rate;
  for (std::size_t i = 0; i < 2; ++i) {
    const double dipole = restoring[i + 1].stiffness / pull;  // V GM
    WaveMode& mode = modes.tilt[i];
    mode.motion = restoring[i + 1].motion;
    mode.strength = source.damping * pull * dipole * dipole / (area * area) * 1.14 *
                    portable::exp(1.2 * log_per_depth - 2.6 * portable::log(k.width[i]));
    mode.rate = 2.7 * std::sqrt(gravity / (k.width[i] * k.length));
    mode.loss = 1.12 * mode.rate;
  }
  return modes;
}

void meetModes(const WaveModes& modes, const Matrix3& to_world, WaveMemory& waves) noexcept {
  if (!(modes.heave.rate > 0)) {
    waves = {};
    return;
  }
  const Oscillation heave{waves.heave[0], waves.heave[1]};
  const double by_heave = scaleTo(waves.heave_energy, heave.energy(modes.heave));
  for (double& state : waves.heave) state *= by_heave;
  waves.heave_energy = by_heave * by_heave * heave.energy(modes.heave);
  const double before = waves.tilt_energy;
  Oscillation tilt[2];
  for (int i = 0; i < 2; ++i) tilt[i] = tiltAlong(waves, axisOf(modes.tilt[i], to_world));
  const double by_tilt =
      scaleTo(before, tilt[0].energy(modes.tilt[0]) + tilt[1].energy(modes.tilt[1]));
  for (Oscillation& s : tilt) s = {by_tilt * s.first, by_tilt * s.second};
  setTilt(modes, to_world, tilt, waves);
}

Vector6 exchangeWaves(const WaveModes& modes, const Matrix3& to_world,
                      const Matrix6& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept {
  if (!(modes.heave.rate > 0)) return x;
  Oscillation heave{waves.heave[0], waves.heave[1]};
  Vector6 end = exchangeMode(modes.heave, inverse_inertia, duration, x, heave);
  waves.heave[0] = heave.first;
  waves.heave[1] = heave.second;
  waves.heave_energy = heave.energy(modes.heave);
  Oscillation tilt[2];
  for (int i = 0; i < 2; ++i) {
    tilt[i] = tiltAlong(waves, axisOf(modes.tilt[i], to_world));
    end = exchangeMode(modes.tilt[i], inverse_inertia, duration, end, tilt[i]);
  }
  setTilt(modes, to_world, tilt, waves);
  return end;
}

}  // namespace ambient
