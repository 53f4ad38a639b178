#include "bullet_ambient/motion/body_waves.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/spatial/symmetric_eigen.h"

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

struct Scales {
  double length;     ///< L [m]
  double per_depth;  ///< L/d
  double width[2];   ///< B_i / L
  double steepness;  ///< q
};

}  // namespace

WaveModes waveModesOf(const WaveSource& source) noexcept {
  const Waterplane& plane = source.wet.waterplane;
  const double area = plane.area, gravity = source.plane.gravity;
  if (!(area > 0) || !(gravity > 0)) return {};
  const Vector3& s = source.plane.normal;
  // The largest two of its three moments are those of the waterplane; the third is along s.
  const auto eigen = symmetricEigen<3>(plane.spread);
  Vector3 axes[2] = {eigen.vectors.col(2), eigen.vectors.col(1)};
  axes[0] = (axes[0] - s.dot(axes[0]) * s).normalized();
  axes[1] = s.cross(axes[0]);
  const double about[2] = {std::max(0.0, axes[1].dot(plane.spread * axes[1])),
                           std::max(0.0, axes[0].dot(plane.spread * axes[0]))};  // I_1, I_2
  Scales k;
  k.length = std::sqrt(area);
  const double depth = (source.wet.volume + source.heave_inertia) / area;
  k.per_depth = std::clamp(k.length / depth, 0.1, 8.0);
  for (int i = 0; i < 2; ++i)
    k.width[i] = std::clamp(std::sqrt(12 * about[i] / area) / k.length, 0.2, 5.0);
  const double steep = std::max(k.width[0], k.width[1]) * k.per_depth;
  k.steepness = 1 + steep * steep / 30;

  WaveModes modes;
  const double pull = source.plane.density * gravity;
  modes.heave.motion = stack(plane.centroid.cross(s), s);
  modes.heave.stiffness = pull * area;
  modes.heave.strength = source.damping * pull * area * 0.075 * k.per_depth * k.per_depth *
                         std::pow(k.steepness, -0.63);
  modes.heave.rate =
      0.66 * std::pow(k.per_depth, 0.9) / std::cbrt(k.steepness) * std::sqrt(gravity / k.length);
  modes.heave.loss = 1.5 * modes.heave.rate;
  for (int i = 0; i < 2; ++i) {
    WaveMode& mode = modes.tilt[i];
    const double dipole = about[i] + s.dot(source.wet.moment);  // V GM
    mode.motion = stack(axes[i], Vector3::Zero());
    mode.stiffness = pull * dipole;
    mode.strength = source.damping * pull * dipole * dipole / (area * area) * 1.14 *
                    std::pow(k.per_depth, 1.2) * std::pow(k.width[i], -2.6);
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
