#pragma once

#include <array>
#include <utility>

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Wrenches on a body or link in its last substep, mean over it: torque about the centre of mass
/// [N m] and force [N], world axes. With the substep h, the dry momentum p = (J w, m v) and all
/// that Bullet applies, gravity included,
///
///   p_1 - p_0 = h (applied + total() + constraints)
///
/// to the rounding of Bullet's velocities; docs/water.md, "What the fluid does". Bullet's own
/// damping of rigid bodies acts before p_0.
struct FluidWrench {
  /// Docs/theory.md eq. (15), (43), (16): at the middle of the way, for the mean velocity.
  Wrench pressure, friction;
  Wrench buoyancy;  ///< eq. (18), (19), (53): there
  Wrench waves;     ///< of those that the body has made, eq. (70)
  Wrench wind;      ///< surface loads of the fluid above a surface of water
  /// Reaction of the added mass. Of a rigid body with free axes, and of a multibody without joints
  /// in free flight, what the balance leaves to it. Otherwise the change of the momentum of the
  /// fluid that moves along.
  Wrench added_mass;
  /// Contacts, joints, motors, locked axes, and a multibody's damping. Of a rigid body with free
  /// axes the impulses of its rows, otherwise what the balance leaves to them.
  Wrench constraints;

  /// Wrench of the fluid.
  Wrench total() const { return pressure + friction + buoyancy + waves + wind + added_mass; }
};

/// Names of the parts in files and in Python, the constraints last.
constexpr std::array<std::pair<const char*, Wrench FluidWrench::*>, 7> kWrenchParts{
    {{"pressure", &FluidWrench::pressure},
     {"friction", &FluidWrench::friction},
     {"buoyancy", &FluidWrench::buoyancy},
     {"waves", &FluidWrench::waves},
     {"wind", &FluidWrench::wind},
     {"added_mass", &FluidWrench::added_mass},
     {"constraints", &FluidWrench::constraints}}};

}  // namespace ambient
