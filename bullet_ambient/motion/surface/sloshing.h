#pragma once

#include <cstddef>
#include <vector>

#include "bullet_ambient/force/surface/hold_shape.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/surface/symmetric_matrix.h"

namespace ambient {

/// What the water in a hold does against its level surface, from step to step: the pendulums of its
/// modes, docs/theory.md eq. (152). World vectors, so that a vessel turns under its water.
struct Sloshing {
  bool is_known = false;            ///< false: the water moves with the vessel and is level
  Vector3 displacement_W{0, 0, 0};  ///< q [m]
  Vector3 velocity_W{0, 0, 0};      ///< u, relative to the water around [m/s]
};

/// Modes of the water in the holds of a body at a pose.
struct SloshingAt {
  double density;          ///< of the water less that of the fluid above [kg/m^3]
  const HoldModes* modes;  ///< in B
  std::size_t count;       ///< of holds
  Matrix3 to_world;        ///< B to W
};

/// Lets water that is not yet known move with a body of the twist x, in B relative to the water
/// around, as if it had been level for ever.
void joinVessel(const SloshingAt& at, const Vector6& x, Sloshing* states) noexcept;

/// Energy of the pendulums [J].
struct SloshingEnergy {
  double kinetic = 0, potential = 0;
  double sum() const { return kinetic + potential; }
};
SloshingEnergy energyOfSloshing(const SloshingAt& at, const Sloshing* states) noexcept;

/// Momentum of the pendulums, world axes, about the centre of mass of the body [N m s, N s].
Momentum momentumOfSloshing(const SloshingAt& at, const Sloshing* states) noexcept;

/// Takes the states to other modes, which never adds energy. Those of holds without modes become
/// not known. `energy`: with the modes before [J]. Returns the energy thereafter [J].
double projectOnModes(const SloshingAt& at, double energy, Sloshing* states) noexcept;

/// A mode in the motion of its body, as it is for a state.
struct SloshAlong {
  SloshAlong() = default;
  /// `damping`: HoldSettings::sloshing_damping.
  SloshAlong(const SloshingAt& at, const SloshMode& of, double damping,
             const Sloshing& state) noexcept;

  /// Gives the state another way and velocity along its axis.
  void move(double way, double velocity, Sloshing& state) const {
    state.displacement_W += (way - mode.way) * axis_W;
    state.velocity_W += (velocity - mode.velocity) * axis_W;
  }

  Vector3 axis_W;
  SloshOf<double> mode;
};

/// Lets pendulums and body act on each other for `duration` [s], docs/theory.md eq. (153): the sum
/// of x.K x / 2 and the energy of the pendulums does not grow, whatever the duration. Returns the
/// twist afterwards, in B, relative to the water around, as x is the one before. `inverse` is K^-1,
/// `damping` HoldSettings::sloshing_damping.
Vector6 exchangeSloshing(const SloshingAt& at, const SymmetricMatrix& inverse, double damping,
                         double duration, const Vector6& x, Sloshing* states) noexcept;

}  // namespace ambient
