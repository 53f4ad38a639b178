#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/attach_def.h"
#include "bullet_ambient/bullet/conversions.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/region_id.h"
#include "bullet_ambient/bullet/step_errors.h"
#include "bullet_ambient/bullet/substep_outcome.h"
#include "bullet_ambient/bullet/surface_encounter.h"
#include "bullet_ambient/bullet/velocity_basis.h"
#include "bullet_ambient/force/load_tables.h"
#include "bullet_ambient/force/surface_loads.h"
#include "bullet_ambient/motion/axis_locks.h"
#include "bullet_ambient/motion/flight.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

class FluidRegions;

/// The loads of a body in one of the media that it may meet; null: there are none.
struct MediumLoads {
  FluidKind kind;
  std::shared_ptr<const SurfaceLoads> loads;
};

/// One attached body.
struct AmbientBody {
  btRigidBody* body = nullptr;  ///< may have been destroyed: look it up in a world first
  int instance = 0;             ///< instanceNumber() of the body that was attached
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
  Twist left_W;  ///< velocity after the last flight, world axes
  AmbientCounters counters;
  StepErrors step_errors;
  int gaping = 0;  ///< steps in a row in which a joint missed by much of its size
  SubstepOutcome outcome;
  AmbientBody* next_met = nullptr;  ///< in the list of AmbientBodies::takeMet()

  bool isInFluid() const { return medium.density > 0; }
  /// The fluids whose surface is near; null: none.
  const SurfaceMedia* surface() const {
    return encounter.media >= 0 ? &surfaces[static_cast<std::size_t>(encounter.media)] : nullptr;
  }
  SurfaceMedia* surface() {
    return encounter.media >= 0 ? &surfaces[static_cast<std::size_t>(encounter.media)] : nullptr;
  }
  /// In which sizes of its motion are compared.
  const BodyModel& metric() const { return surface() ? surface()->model.below : model; }
};

/// Counts evaluations of the loads on a body.
inline void countLoads(AmbientBody& ambient, int evaluations) noexcept {
  if (evaluations == 0) return;
  const SurfaceMedia* surface = ambient.surface();
  const auto& loads = surface ? surface->model.loads_below.loads : ambient.model.loads;
  ambient.counters.load_evaluations += evaluations;
  if (loads) ambient.counters.faces += static_cast<long long>(evaluations) * loads->faces();
}

/// Pose and twist of a btRigidBody, its twist in body axes.
RigidState readState(const btRigidBody& body);

/// Linear and angular factors of a btRigidBody.
AxisFactors axisFactors(const btRigidBody& body);

/// Gravity, applied forces and torques, and the ambient flow at the start of a step.
Surroundings readSurroundings(const AmbientBody& ambient);

/// Builds model and velocity basis from the body's mass properties as they are now; the loads stay.
/// @throws std::invalid_argument as makeBodyModel().
void rebuildModel(AmbientBody& ambient);

/// Whether setMassProps was called since the model was built.
bool isModelStale(const AmbientBody& ambient);

/// Has the model rebuilt when the body is next met.
inline void markStale(AmbientBody& ambient) noexcept { ambient.seen_inverse_mass = -1; }

/// Makes the loads in all media that the body may meet, puts it into its own, and builds the model
/// if it is dynamic at present, or else when it next is: until then, it has one of unit mass and
/// inertia. What throws changes nothing.
/// @throws std::invalid_argument as makeSurfaceLoads() and makeBodyModel().
void refreshModel(AmbientBody& ambient, const FluidRegions& regions, LoadTables& tables);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
