#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/medium/medium.h"
#include "tests/study/stability/atlas_shapes.h"

namespace ambient {

/// Surroundings besides the fluid.
enum class AtlasSetting {
  kFree,     ///< no gravity, no contact
  kFalling,  ///< gravity
  kOnPlane,  ///< gravity, a plane half a size below the body
  kOnJoint,  ///< gravity, a point of the body's rim held in place
};
constexpr int kAtlasSettings = 4;

/// One run of the stability atlas.
struct AtlasCase {
  const AtlasShape* shape = nullptr;
  AtlasSetting setting = AtlasSetting::kFree;
  PressureLaw law = PressureLaw::kForm;
  bool water = false;
  double density_ratio = 1;  ///< body over fluid
  double size = 1;           ///< [m]
  double speed = 0;          ///< at the start [m/s]
  double spin = 0;           ///< at the start [rad/s]
  double step = 1.0 / 60;    ///< [s]
  unsigned seed = 0;         ///< determines velocity, spin and orientation
  /// Mass of a second body on top of the first, over the first's; 0: no second body. With it both
  /// bodies start unrotated in the world.
  double load_ratio = 0;
};

struct AtlasResult {
  bool finite = true;  ///< state after every step
  /// Largest rise of total energy above any earlier value, over the largest kinetic energy plus
  /// that of a fall of all bodies by the size.
  double energy_rise = 0;
  long long rejected = 0;  ///< steps dropped for a result that was not finite
  double coarse = 0;       ///< part of steps with an error above the tolerance
};
}  // namespace ambient

AMBIENT_BEGIN

constexpr double kAtlasDuration = 2;  ///< duration of a run [s]

enum class AtlasFluid { kAttached, kNone };

/// Runs one case in a btDiscreteDynamicsWorld with default settings. Without fluid: stock Bullet in
/// a vacuum.
AtlasResult runAtlasCase(const AtlasCase& atlas_case, AtlasFluid fluid = AtlasFluid::kAttached);

AMBIENT_END
