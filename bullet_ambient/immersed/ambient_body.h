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

/// Loads of one body in one of the media that it may meet.
struct MediumLoads {
  FluidKind kind;
  std::shared_ptr<const SurfaceLoads> loads;
};

/// Everything that the library keeps of one body in a fluid. Links have one each, too, with a
/// stand-in for the btRigidBody.
struct AmbientBody {
  btRigidBody* body = nullptr;  ///< may have been destroyed: look it up in a world first
  int instance = 0;             ///< instanceNumber() of the body that was attached
  int slot = -1;                ///< in MemberSlots; -1: not yet there
  AttachDef def;
  Medium medium;                   ///< medium around the body now: its own, or that of its region
  RegionPlace place;               ///< kNone: the body is in its own medium
  std::vector<MediumLoads> media;  ///< loads per medium; the first entry is for the own medium
  std::vector<SurfaceMedia> surfaces;
  SurfaceEncounter encounter;
  bool is_frozen = false;  ///< true: `model` is that of the body at a water surface at one moment
  bool may_rest = true;    ///< true: nothing around the body changes with time
  BodyModel model;
  Matrix6 basis_B = Matrix6::Identity();
  btScalar seen_inverse_mass = 0;  ///< dry mass properties the model was built from
  btVector3 seen_inverse_inertia{0, 0, 0};
  FlightMemory memory;
  Twist left_W;           ///< velocity of the body after its last flight, world axes
  Wake wake;              ///< wake behind a smooth body, docs/theory.md eq. (51b)
  double load_share = 1;  ///< factor on the surface loads in this step, docs/theory.md eq. (51d)
  AmbientCounters counters;
  StepErrors step_errors;
  int gaping =
      0;  ///< number of steps in a row in which a joint of the body was open by much of its size
  SubstepOutcome outcome;
  std::shared_ptr<FluidReading>
      reading;                      ///< record for Immersed::wrench(); null: the wrench is not read
  AmbientBody* next_met = nullptr;  ///< next body in the list of AmbientBodies::takeMet()

  bool isInFluid() const { return medium.density > 0; }
  /// The two fluids at the water surface near the body; null: no surface is near.
  const SurfaceMedia* surface() const {
    return encounter.media >= 0 ? &surfaces[static_cast<std::size_t>(encounter.media)] : nullptr;
  }
  SurfaceMedia* surface() {
    return encounter.media >= 0 ? &surfaces[static_cast<std::size_t>(encounter.media)] : nullptr;
  }
  /// Model whose inertia K defines the norm sqrt(x.K x) of velocity changes.
  const BodyModel& metric() const { return surface() ? surface()->model.below : model; }
};

/// Surface loads of the fluid around a body; at a water surface those of the fluid below. Null:
/// there are none.
inline const std::shared_ptr<const SurfaceLoads>& loadsOn(const AmbientBody& ambient) noexcept {
  const SurfaceMedia* surface = ambient.surface();
  return surface ? surface->model.loads_below.loads : ambient.model.loads;
}

/// Adds a number of load evaluations to the counters of a body.
inline void countLoads(AmbientBody& ambient, int evaluations) noexcept {
  if (evaluations == 0) return;
  const auto& loads = loadsOn(ambient);
  ambient.counters.load_evaluations += evaluations;
  if (loads) ambient.counters.faces += static_cast<long long>(evaluations) * loads->faces();
}

/// Reads the velocity of a btRigidBody, world axes.
inline Twist velocityOf(const btRigidBody& body) {
  return {toVector3(body.getAngularVelocity()), toVector3(body.getLinearVelocity())};
}

/// Reads pose and twist of a btRigidBody; pose in W, twist in body axes.
RigidState readState(const btRigidBody& body);

/// Reads the linear and angular factors of a btRigidBody, world axes.
AxisFactors axisFactors(const btRigidBody& body);

/// Collects gravity, applied forces and torques, and the ambient flow at the start of a step; world
/// axes.
Surroundings readSurroundings(const AmbientBody& ambient);

/// Lets the wake of a smooth body follow its motion over a step of `duration` [s], and sets
/// `load_share`; docs/theory.md eq. (51c), (51d).
void followWake(AmbientBody& ambient, double duration) noexcept;

/// Builds `model` and `basis_B` from the body's present mass properties and from `loads`, those in
/// the medium around the body; null: no surface loads.
/// @throws std::invalid_argument as makeBodyModel().
void buildModel(AmbientBody& ambient, const std::shared_ptr<const SurfaceLoads>& loads);

/// Gives a body that is static or kinematic at present a model of mass 1 kg and inertia 1 kg m^2.
/// It serves until the body is dynamic.
/// @throws std::invalid_argument as makeBodyModel().
void buildUnitModel(AmbientBody& ambient, const std::shared_ptr<const SurfaceLoads>& loads);

/// Builds the model again with its present loads, after a change of mass.
/// @throws std::invalid_argument as makeBodyModel().
inline void rebuildModel(AmbientBody& ambient) { buildModel(ambient, ambient.model.loads); }

/// True if the mass properties differ from those that the model was built from: setMassProps() was
/// called.
bool isModelStale(const AmbientBody& ambient);

/// Makes isModelStale() true, so that the next step rebuilds the model.
inline void markStale(AmbientBody& ambient) noexcept { ambient.seen_inverse_mass = -1; }

AMBIENT_END
