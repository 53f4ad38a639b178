#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "bullet_ambient/force/surface/hold_flow.h"
#include "bullet_ambient/force/surface/hold_shape.h"
#include "bullet_ambient/motion/body/body_model.h"

namespace ambient {

/// Holds of a body and the openings through which water comes into them, in F. Immutable; shared by
/// equal bodies.
struct HoldShapes {
  struct Opening {
    OpeningShape shape;
    int from;  ///< the hold
    int to;    ///< the hold that it leads to; -1: the fluid outside
  };

  explicit HoldShapes(const std::vector<Hold>& holds);

  std::vector<HoldShape> shapes;
  std::vector<Opening> openings;  ///< those of the first hold first
};

/// A hole in a wall that one body has got while it is in its fluid.
struct AddedHole : WallHole {
  int hold = 0;
};

/// Changes of the openings of one body: those that are shut, and holes that its shape has not.
struct OpeningChanges {
  std::vector<std::uint8_t> is_shut;       ///< of HoldShapes::openings, and then of those added
  std::vector<AddedHole> holes;            ///< those added
  std::vector<HoldShapes::Opening> added;  ///< their shapes

  void add(const AddedHole& hole);
};

/// Heights of a sea with waves above its plane, at the edges of each opening [m], in the order of
/// forEachOpening().
using RimRises = std::vector<std::vector<double>>;

/// Calls a function for each opening that is not shut, with its number among all. `changes`: null:
/// none.
template <class Function>
void forEachOpening(const HoldShapes& holds, const OpeningChanges* changes,
                    const Function& function) {
  const auto visit = [&](const HoldShapes::Opening& opening, std::size_t i) {
    if (!changes || i >= changes->is_shut.size() || !changes->is_shut[i]) function(opening, i);
  };
  std::size_t i = 0;
  for (const HoldShapes::Opening& opening : holds.openings) visit(opening, i++);
  if (!changes) return;
  for (const HoldShapes::Opening& opening : changes->added) visit(opening, i++);
}

/// Water in one hold of a body, from step to step.
struct HoldState {
  double volume = 0;                ///< [m^3]
  double displaced = 0;             ///< by other bodies in it [m^3]
  double change = 0;                ///< of the volume in the last step [m^3]
  double inflow = 0;                ///< the part of it from outside; negative: out [m^3]
  double pump = 0;                  ///< from outside by a pump; negative: out [m^3/s]
  double flooded = 0, drained = 0;  ///< what has come from outside and left in all [m^3]
  bool is_sealed = false;           ///< true: water shuts off its air from that outside
  double air = 0;                   ///< pressure times volume of that air [J]
  /// While water flows: height of its level along the normal in F, NaN: not known [m]; and the
  /// number of the first hold with the same sealed air, -1: that outside.
  double level = std::numeric_limits<double>::quiet_NaN();
  int air_group = -1;

  /// Volume below its level: of water and of what floats in it [m^3].
  double filled() const { return volume + displaced; }
};

/// Waves of the water in the holds of a body where they reach its openings to the sea.
struct WavesInside {
  bool is_any = false;                ///< true: one reaches an opening
  RimRises rises;                     ///< of those over the level in the hold
  std::vector<std::uint8_t> reaches;  ///< of the openings; 1: `rises` counts
  std::vector<double> energy;         ///< of the waves in each hold, over rho g [m^4]
  std::vector<double> lost;           ///< the part of it that has gone with water [m^4]

  /// Heights at the edges of an opening; null: the water is level there.
  const std::vector<double>* at(std::size_t opening) const {
    return reaches[opening] ? &rises[opening] : nullptr;
  }
};

/// Air around the holds and a duration in which water flows.
struct ExchangeStep {
  bool are_open = true;                     ///< false: nothing passes through openings
  double duration = 0;                      ///< [s]
  double atmosphere = 101325;               ///< pressure of the air at the surface [Pa]
  const OpeningChanges* changes = nullptr;  ///< null: none
  const RimRises* rises = nullptr;          ///< null: the sea is a plane at the openings
  /// Levels and modes of the holds at the plane, with their present water; null: not known.
  const HoldModes* modes = nullptr;
  WavesInside* waves = nullptr;  ///< null: the water in the holds is level
};

/// Water in all holds of a body at one pose: what it adds to the closed vessel.
struct WaterInside {
  bool is_any = false;
  /// Terms of V, S and W in docs/theory.md eq. (135), in F: volume and moment are negative.
  WetVolume below;
  Matrix3 spread = Matrix3::Zero();  ///< sum of Waterplane::spread of its levels, in F [m^4]
  SymmetricMatrix inertia;           ///< in B, of the water less that of its modes of sloshing
  const HoldModes* modes = nullptr;  ///< of each hold, in B; null: not kept

  /// Returns the wet part of the closed vessel less the water; the waterplane is that outside.
  WetVolume with(WetVolume vessel) const noexcept {
    vessel.volume += below.volume;
    vessel.moment += below.moment;
    vessel.depth_integral += below.depth_integral;
    return vessel;
  }
};

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

/// Twist in B, relative to the water around, and energy of the pendulums [J].
struct Sloshed {
  Vector6 twist;
  double energy = 0;
};
/// Lets pendulums and body act on each other for `duration` [s], docs/theory.md eq. (153): the sum
/// of x.K x / 2 and the energy of the pendulums does not grow, whatever the duration. x: twist
/// before; `inverse`: K^-1; `damping`: HoldSettings::sloshing_damping.
Sloshed exchangeSloshing(const SloshingAt& at, const SymmetricMatrix& inverse, double damping,
                         double duration, const Vector6& x, Sloshing* states) noexcept;

/// Sloshing in the holds of a body, one of each.
struct VesselSloshing {
  std::vector<Sloshing> now;    ///< from step to step
  std::vector<Sloshing> moved;  ///< in a step
  std::vector<HoldModes> modes,
      later;  ///< in B at the flotation of the body; where a step comes to

  /// For a number of holds.
  void resize(std::size_t count);
};

/// Water in the holds of a body, and where what follows from it at a place is kept as long as the
/// place. Null: without holds.
struct VesselWater {
  const HoldState* states = nullptr;
  WaterInside* inside = nullptr;
  HoldModes* modes = nullptr;          ///< of each hold; null: not kept
  VesselSloshing* sloshing = nullptr;  ///< @pre not null in flights
  double damping = 0.03;               ///< HoldSettings::sloshing_damping
};

/// Finds the levels of the water in the holds and sums over it. Cost: one to three clips of each
/// hold with water.
/// @param holds of the body
/// @param states one of each hold
/// @param plane_F of the water outside
/// @param frame pose of F in B
/// @param density of the water less that of the fluid above [kg/m^3]
/// @param modes where those of each hold are kept; null: nowhere
WaterInside waterInside(const HoldShapes& holds, const HoldState* states,
                        const SurfacePlane& plane_F, const FrameOffset& frame, double density,
                        HoldModes* modes = nullptr) noexcept;

/// Tells if all holds are full of water.
bool areFull(const HoldShapes& holds, const HoldState* states) noexcept;
/// Tells if all holds are empty.
bool areEmpty(const HoldShapes& holds, const HoldState* states) noexcept;

/// Fills the holds that have openings and are all below a plane, and empties the others.
void fillCoveredHolds(const HoldShapes& holds, const OpeningChanges* changes,
                      const SurfacePlane& plane_F, HoldState* states) noexcept;

/// Mixes the sloshing in holds with that of water that has passed: what has come from outside was
/// at rest there, other water moves with the vessel. `before` and `after`: modes before and after
/// water has passed; x: twist of the vessel in B, relative to the water around.
void mixSloshing(const HoldState* states, const HoldModes* before, const SloshingAt& after,
                 const Vector6& x, Sloshing* sloshing) noexcept;

}  // namespace ambient
