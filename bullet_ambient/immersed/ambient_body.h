#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/core/velocity_basis.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/immersed/attach_def.h"
#include "bullet_ambient/immersed/region_id.h"
#include "bullet_ambient/immersed/step_errors.h"
#include "bullet_ambient/immersed/substep_outcome.h"
#include "bullet_ambient/immersed/surface_media.h"
#include "bullet_ambient/motion/body/wake.h"
#include "bullet_ambient/motion/flight/axis_locks.h"
#include "bullet_ambient/motion/flight/flight.h"

AMBIENT_BEGIN

struct FluidReading;

/// The loads of a body in one of the media that it may meet; null: there are none.
struct MediumLoads {
  FluidKind kind;
  std::shared_ptr<const SurfaceLoads> loads;
};

/// One attached body.
struct AmbientBody {
  btRigidBody* body = nullptr;  ///< may have been destroyed: look it up in a world first
  int instance = 0;             ///< instanceNumber() of the body that was attached
  int slot = -1;                ///< in MemberSlots; -1: not yet there
  AttachDef def;
  Medium medium;                   ///< around it now: its own, or that of its region
  RegionPlace place;               ///< none, if the medium is its own
  std::vector<MediumLoads> media;  ///< its own first
  std::vector<SurfaceMedia> surfaces;
  SurfaceEncounter encounter;
  bool is_frozen = false;  ///< the model is that of the surface at some moment
  bool may_rest = true;    ///< nothing around it changes with time
  BodyModel model;
  Matrix6 basis_B = Matrix6::Identity();
  btScalar seen_inverse_mass = 0;  ///< dry mass properties the model was built from
  btVector3 seen_inverse_inertia{0, 0, 0};
  FlightMemory memory;
  Twist left_W;           ///< velocity after the last flight, world axes
  Wake wake;              ///< of a smooth body
  double load_share = 1;  ///< of its loads in this step, docs/theory.md eq. (51d)
  AmbientCounters counters;
  StepErrors step_errors;
  int gaping = 0;  ///< steps in a row in which a joint missed by much of its size
  SubstepOutcome outcome;
  std::shared_ptr<FluidReading> reading;  ///< null: its wrench is not read
  AmbientBody* next_met = nullptr;        ///< in the list of AmbientBodies::takeMet()

  bool isInFluid() const { return medium.density > 0; }
  /// The fluids whose surface is near; null: none.
  const SurfaceMedia* surface() const {
    return encounter.media >= 0 ? &surfaces[static_cast<std::size_t>(encounter.media)] : nullptr;
  }
  SurfaceMedia* surface() {
    return encounter.media >= 0 ? &surfaces[static_cast<std::size_t>(encounter.media)] : nullptr;
  }
  /// Model whose inertia K defines the norm sqrt(x.K x) of velocity changes.
  const BodyModel& metric() const { return surface() ? surface()->model.below : model; }
};

/// Loads of the fluid around a body, or below it at a surface; null: there are none.
inline const std::shared_ptr<const SurfaceLoads>& loadsOn(const AmbientBody& ambient) noexcept {
  const SurfaceMedia* surface = ambient.surface();
  return surface ? surface->model.loads_below.loads : ambient.model.loads;
}

/// Counts evaluations of the loads on a body.
inline void countLoads(AmbientBody& ambient, int evaluations) noexcept {
  if (evaluations == 0) return;
  const auto& loads = loadsOn(ambient);
  ambient.counters.load_evaluations += evaluations;
  if (loads) ambient.counters.faces += static_cast<long long>(evaluations) * loads->faces();
}

/// Pose and twist of a btRigidBody, its twist in body axes.
RigidState readState(const btRigidBody& body);

/// Linear and angular factors of a btRigidBody.
AxisFactors axisFactors(const btRigidBody& body);

/// Gravity, applied forces and torques, and the ambient flow at the start of a step.
Surroundings readSurroundings(const AmbientBody& ambient);

/// Lets the wake of a smooth body follow it over a step, and sets the share of its loads that acts
/// in this step.
void followWake(AmbientBody& ambient, double duration) noexcept;

/// Builds model and velocity basis from the body's mass properties as they are now, and from loads
/// in the medium around it; null: there are none.
/// @throws std::invalid_argument as makeBodyModel().
void buildModel(AmbientBody& ambient, const std::shared_ptr<const SurfaceLoads>& loads);

/// Gives a body that is not dynamic at present a model of unit mass and inertia, until it is.
/// @throws std::invalid_argument as makeBodyModel().
void buildUnitModel(AmbientBody& ambient, const std::shared_ptr<const SurfaceLoads>& loads);

/// Builds the model anew with the loads that it has.
/// @throws std::invalid_argument as makeBodyModel().
inline void rebuildModel(AmbientBody& ambient) { buildModel(ambient, ambient.model.loads); }

/// Whether setMassProps was called since the model was built.
bool isModelStale(const AmbientBody& ambient);

/// Has the model rebuilt when the body is next met.
inline void markStale(AmbientBody& ambient) noexcept { ambient.seen_inverse_mass = -1; }

AMBIENT_END
