#pragma once

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/force/flow_settings.h"
#include "bullet_ambient/force/medium.h"
#include "demos/study/atlas_shapes.h"

namespace ambient {

/// What else is there besides body and fluid.
enum class AtlasSetting {
  kFree,     ///< nothing, no gravity
  kFalling,  ///< gravity
  kOnPlane,  ///< gravity, a plane half a size below the body
  kOnJoint,  ///< gravity, a point of the body's rim held in place
};
constexpr int kAtlasSettings = 4;

/// One run of the stability atlas.
struct AtlasCase {
  const AtlasShape* shape = nullptr;
  AtlasSetting setting = AtlasSetting::kFree;
  PressureLaw law = PressureLaw::kPublished;
  bool water = false;
  double density_ratio = 1;  ///< body over fluid
  double size = 1;           ///< [m]
  double speed = 0;          ///< at the start [m/s]
  double spin = 0;           ///< at the start [rad/s]
  double step = 1.0 / 60;    ///< [s]
  unsigned seed = 0;         ///< of the directions of velocity, spin and orientation
  /// Mass of a second body that lies upon the first, over the first's; 0: there is none. Both begin
  /// in the axes of the world.
  double load_ratio = 0;
};

struct AtlasResult {
  bool finite = true;  ///< state after every step
  /// Largest rise of the energy of bodies and fluid, potential included, above any earlier value;
  /// over the largest kinetic energy plus that of a fall of all by the body's size.
  double energy_rise = 0;
  long long rejected = 0;  ///< steps whose result was not finite and was not taken over
  double coarse = 0;       ///< part of the steps whose error stayed above the tolerance
};

inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

constexpr double kAtlasDuration = 2;  ///< of a run [s]

enum class AtlasFluid { kAttached, kNone };

/// Runs one case in a btDiscreteDynamicsWorld with default settings; without the fluid, as stock
/// Bullet in a vacuum.
AtlasResult runAtlasCase(const AtlasCase& atlas_case, AtlasFluid fluid = AtlasFluid::kAttached);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
