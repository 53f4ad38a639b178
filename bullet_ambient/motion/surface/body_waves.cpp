#include "bullet_ambient/motion/surface/body_waves.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/wave_kernel.h"

namespace ambient {
namespace {

Vectors axisOf(const Vector6& motion) { return inAllLanes(Vector3(motion.head<3>())); }

Restorings inAllLanes(const RestoringModes& modes) {
  Restorings all_modes;
  all_modes.heave = inAllLanes(modes[0].motion);
  for (int i = 0; i < 3; ++i) all_modes.stiffness[i] = all(modes[i].stiffness);
  for (int i = 0; i < 2; ++i) all_modes.tilt[i] = axisOf(modes[i + 1].motion);
  return all_modes;
}

void setWave(Waves& waves, int i, const WaveMode& mode) {
  waves.strength[i] = all(mode.strength);
  waves.loss[i] = all(mode.loss);
  waves.rate[i] = all(mode.rate);
}

WaveStates inAllLanes(const WaveMemory& waves) {
  return {{all(waves.heave[0]), all(waves.heave[1])},
          {inAllLanes(waves.tilt_W[0]), inAllLanes(waves.tilt_W[1])},
          all(waves.heave_energy),
          all(waves.tilt_energy)};
}

WaveMemory ofFirstLane(const WaveStates& waves) {
  return {{waves.heave.first[0], waves.heave.second[0]},
          {ofFirstLane(waves.tilt_W[0]), ofFirstLane(waves.tilt_W[1])},
          waves.heave_energy[0],
          waves.tilt_energy[0]};
}

}  // namespace

Matrix6 stiffened(const Matrix6& inertia, const RestoringModes& modes, double duration) noexcept {
  AMBIENT_ASSERT(duration >= 0);
  return ofFirstLane(stiffened(inAllLanes(inertia), inAllLanes(modes), all(duration)));
}

Vector6 exchangeWaves(const WaveModes& modes, const Matrix3& to_world,
                      const Matrix6& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept {
  AMBIENT_ASSERT(duration >= 0 && !(waves.heave_energy < 0) && !(waves.tilt_energy < 0));
  Restorings motions;
  motions.heave = inAllLanes(modes.heave.motion);
  Waves oscillators;
  setWave(oscillators, 0, modes.heave);
  Vectors tilt_W[2];
  for (int i = 0; i < 2; ++i) {
    motions.tilt[i] = axisOf(modes.tilt[i].motion);
    tilt_W[i] = inAllLanes(Vector3(to_world * modes.tilt[i].motion.head<3>()));
    setWave(oscillators, i + 1, modes.tilt[i]);
  }
  const WaveModesOfBodies met{motions, oscillators, {tilt_W[0], tilt_W[1]}};
  WaveStates states = inAllLanes(waves);
  meetModes(met, states);
  const Spatials end =
      exchangeWaves(met, inAllLanes(inverse_inertia), all(duration), inAllLanes(x), states);
  waves = ofFirstLane(states);
  return ofFirstLane(end);
}

Wrench waveWrench(const WaveModes& modes, const Matrix3& to_world, const WaveMemory& before,
                  const WaveMemory& after) noexcept {
  const double heave = (before.heave[0] + after.heave[0]) / 2;
  Vector6 wrench = -modes.heave.strength * heave * modes.heave.motion;
  const Vector3 tilt_B = to_world.transpose() * (before.tilt_W[0] + after.tilt_W[0]) / 2;
  for (const WaveMode& tilt : modes.tilt)
    wrench -= tilt.strength * tilt.motion.head<3>().dot(tilt_B) * tilt.motion;
  return Wrench::fromVector(wrench);
}

}  // namespace ambient
