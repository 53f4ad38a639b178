#pragma once

// The wrench of the fluid on a body or link by part, Immersed::wrench().

#include <array>
#include <utility>

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Wrenches on a body or link, averaged over its last substep: torque about the centre of mass [N
/// m] and force [N], world axes. With the duration h of the substep, the dry momentum p = (J w, m
/// v), and the applied wrench (gravity and all that the program applies),
///
///   p_1 - p_0 = h (applied + total() + constraints)
///
/// holds to the rounding of Bullet's velocities; docs/water.md, "What the fluid does". Bullet's own
/// damping of rigid bodies acts before p_0.
struct FluidWrench {
  /// Surface loads of docs/theory.md eq. (15), (43), (16), at the middle of the path for the mean
  /// velocity.
  Wrench pressure, friction;
  Wrench buoyancy;  ///< buoyancy of eq. (18), (19), (53) at the middle of the path
  Wrench waves;     ///< waves that the body has made, eq. (70)
  Wrench wind;      ///< surface loads of the fluid above a surface of water
  /// Reaction of the added mass, and of the water in holds. For a rigid body with free axes, and
  /// for a multibody without joints in free flight: the remainder of the balance above. Otherwise
  /// the negative change of momentum of the fluid that moves along, over h.
  Wrench added_mass;
  /// Contacts, joints, motors, locked axes, and a multibody's damping. For a rigid body with free
  /// axes: the impulses of its rows over h. Otherwise the remainder of the balance above.
  Wrench constraints;

  /// Sum of all parts but the constraints: the wrench of the fluid.
  Wrench total() const { return pressure + friction + buoyancy + waves + wind + added_mass; }
};

/// Names of the parts in files and in Python; constraints last.
constexpr std::array<std::pair<const char*, Wrench FluidWrench::*>, 7> kWrenchParts{
    {{"pressure", &FluidWrench::pressure},
     {"friction", &FluidWrench::friction},
     {"buoyancy", &FluidWrench::buoyancy},
     {"waves", &FluidWrench::waves},
     {"wind", &FluidWrench::wind},
     {"added_mass", &FluidWrench::added_mass},
     {"constraints", &FluidWrench::constraints}}};

}  // namespace ambient
