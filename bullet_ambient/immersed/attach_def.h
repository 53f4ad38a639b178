#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/motion/flight/flight_settings.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

struct FluidBody;

/// Holds of a vessel, FluidBody::holds, at a surface of water.
struct HoldSettings {
  bool are_open = true;  ///< false: no water passes through their openings
  /// Water in each of them from the start [m^3]. Empty: a hold is empty, or full if it has openings
  /// and is all below the surface when the body first meets it.
  std::vector<double> water = {};
  /// Pressure of the air at the surface, which air that water shuts off in a hold has at first
  /// [Pa].
  double atmosphere = 101325;
  /// Damping of water that sloshes in them, as a share of the critical one; docs/vessels.md.
  double sloshing_damping = 0.03;
};

/// Definition of a body or link in a fluid.
struct AttachDef {
  /// Shared by all bodies of one shape. It does not follow its collision shape: after
  /// setLocalScaling(), which Bullet tells nobody, call Immersed::setFluidBody().
  std::shared_ptr<const FluidBody> fluid_body = nullptr;
  Medium medium = {};  ///< default: vacuum, in which the body moves as in stock Bullet
  /// True: the fluid is that of the region with the highest priority that holds the centre of mass;
  /// `medium` counts only where there is no region. See Fluid::addRegion().
  bool follow_regions = true;
  /// Factor on the damping of a floating body by the waves that it makes; docs/water.md.
  double wave_damping = 1;
  /// Factor on the added mass, > 0: K = K_body + factor rho K_fluid, docs/theory.md eq. (3).
  double added_mass_factor = 1;
  /// Factor on pressure, friction and wind, > 0. Buoyancy and waves have none.
  double load_factor = 1;
  FlowSettings flow = {};
  FlightSettings flight = {};
  HoldSettings holds = {};
  FrameOffset fluid_frame = {};  ///< F in the btRigidBody's frame (centre of mass)
  /// Name in reports and errors. Empty: the name from Fluid::setNaming(), else that of the fluid
  /// body.
  std::string name = {};
};

/// Counts of what was computed for one body or link since it was added to its fluid. Counts that
/// belong to a whole multibody are with its first link.
struct AmbientCounters {
  long long substeps = 0;  ///< substeps of free flight
  long long load_evaluations = 0;
  long long faces = 0;    ///< faces or clusters summed in these evaluations; a sphere has none
  long long guarded = 0;  ///< load evaluations in which the passivity guard acted
  long long coarse = 0;   ///< steps whose error stayed too large at the most substeps or retries
  long long halted = 0;   ///< steps at the surface that ended early, docs/theory.md eq. (64),
                          ///< (68c)
  /// Energy removed by bounds on the energy of a step, docs/theory.md eq. (25a), (31a), (64), (68),
  /// (68a) [J].
  double energy_removed = 0;
  long long rows = 0;  ///< constraint rows rewritten
  long long joint_rows =
      0;  ///< rewritten rows that were solved together before the solver's iterations
  long long rejected =
      0;  ///< results of steps, and samples of regions, that were not finite and not used
  long long regions_asked =
      0;  ///< tests of the body against the bounds of one region or of several
  long long medium_changes = 0;  ///< changes by regions to another density or viscosity
  long long too_long = 0;  ///< bodies whose errors add up: steps are too long for their motion

  AmbientCounters& operator+=(const AmbientCounters& other);
};

inline AmbientCounters& AmbientCounters::operator+=(const AmbientCounters& other) {
  substeps += other.substeps;
  load_evaluations += other.load_evaluations;
  faces += other.faces;
  guarded += other.guarded;
  coarse += other.coarse;
  halted += other.halted;
  energy_removed += other.energy_removed;
  rows += other.rows;
  joint_rows += other.joint_rows;
  rejected += other.rejected;
  regions_asked += other.regions_asked;
  medium_changes += other.medium_changes;
  too_long += other.too_long;
  return *this;
}

}  // namespace ambient
