#include "bullet_ambient/motion/surface/body_waves.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/wave_kernel.h"

namespace ambient {

Vector6 exchangeWaves(const FloatingModes& modes, const Matrix3& to_world,
                      const SymmetricMatrix& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept {
  AMBIENT_ASSERT(duration >= 0 && !(waves.heave_energy < 0) && !(waves.tilt_energy < 0));
  const auto tilt_W = [&](int i) { return plain(Vector3(to_world * asEigen(modes.tilt[i]))); };
  const ModesAtPose<double> at_pose{modes, {tilt_W(0), tilt_W(1)}};
  meetModes(at_pose, waves);
  return asEigen(exchangeWaves(at_pose, inverse_inertia, duration, plain(x), waves));
}

Wrench waveWrench(const FloatingModes& modes, const Matrix3& to_world, const WaveMemory& before,
                  const WaveMemory& after) noexcept {
  const double heave = (before.heave.first + after.heave.first) / 2;
  Wrench wrench = Wrench::fromVector(-modes.strength[0] * heave * asEigen(modes.heave));
  const Vector3 tilt_B = to_world.transpose() * asEigen(before.tilt_W[0] + after.tilt_W[0]) / 2;
  for (int i = 0; i < 2; ++i) {
    const Vector3 axis = asEigen(modes.tilt[i]);
    wrench.torque -= modes.strength[i + 1] * axis.dot(tilt_B) * axis;
  }
  return wrench;
}

}  // namespace ambient
