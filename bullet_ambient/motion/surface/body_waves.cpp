#include "bullet_ambient/motion/surface/body_waves.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/wave_kernel.h"

namespace ambient {
namespace {

Vectors axisOf(const Vector6& motion) { return inAllLanes(Vector3(motion.head<3>())); }

Restorings inAllLanes(const FloatingModes& modes) {
  Restorings all_modes;
  all_modes.heave = inAllLanes(modes[0].motion);
  for (int i = 0; i < 3; ++i) all_modes.stiffness[i] = all(modes[i].stiffness);
  for (int i = 0; i < 2; ++i) all_modes.tilt[i] = axisOf(modes[i + 1].motion);
  return all_modes;
}

Waves wavesInAllLanes(const FloatingModes& modes) {
  Waves waves;
  for (int i = 0; i < 3; ++i) {
    waves.strength[i] = all(modes[i].strength);
    waves.loss[i] = all(modes[i].loss);
    waves.rate[i] = all(modes[i].rate);
  }
  return waves;
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

Matrix6 stiffened(const Matrix6& inertia, const FloatingModes& modes, double duration) noexcept {
  AMBIENT_ASSERT(duration >= 0);
  return ofFirstLane(stiffened(inAllLanes(inertia), inAllLanes(modes), all(duration)));
}

Vector6 exchangeWaves(const FloatingModes& modes, const Matrix3& to_world,
                      const Matrix6& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept {
  AMBIENT_ASSERT(duration >= 0 && !(waves.heave_energy < 0) && !(waves.tilt_energy < 0));
  const auto tilt_W = [&](int i) {
    return inAllLanes(Vector3(to_world * modes[i].motion.head<3>()));
  };
  const WaveModesOfBodies met{inAllLanes(modes), wavesInAllLanes(modes), {tilt_W(1), tilt_W(2)}};
  WaveStates states = inAllLanes(waves);
  meetModes(met, states);
  const Spatials end =
      exchangeWaves(met, inAllLanes(inverse_inertia), all(duration), inAllLanes(x), states);
  waves = ofFirstLane(states);
  return ofFirstLane(end);
}

Wrench waveWrench(const FloatingModes& modes, const Matrix3& to_world, const WaveMemory& before,
                  const WaveMemory& after) noexcept {
  const double heave = (before.heave[0] + after.heave[0]) / 2;
  Vector6 wrench = -modes[0].strength * heave * modes[0].motion;
  const Vector3 tilt_B = to_world.transpose() * (before.tilt_W[0] + after.tilt_W[0]) / 2;
  for (int i = 1; i < 3; ++i)
    wrench -= modes[i].strength * modes[i].motion.head<3>().dot(tilt_B) * modes[i].motion;
  return Wrench::fromVector(wrench);
}

}  // namespace ambient
