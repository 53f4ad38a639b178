#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>

#include "bullet_ambient/bullet/conversions.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/velocity_basis.h"
#include "bullet_ambient/force/load_tables.h"
#include "bullet_ambient/force/surface_loads.h"
#include "bullet_ambient/motion/axis_locks.h"
#include "bullet_ambient/motion/flight.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// How a btRigidBody meets the fluid.
struct AttachDef {
  /// Shared by all bodies of one shape. It does not follow its collision shape: after
  /// setLocalScaling(), which Bullet tells nobody, call AmbientRegistry::setFluidBody().
  std::shared_ptr<const FluidBody> fluid_body;
  Medium medium;  ///< default: vacuum, in which the body moves as in stock Bullet
  FlowSettings flow;
  FlightSettings flight;
  FrameOffset
      fluid_frame;  ///< frame F of the fluid body in the btRigidBody's frame (centre of mass)
};

/// What was computed for one body since it was attached.
struct AmbientCounters {
  long long substeps = 0;  ///< of free flight
  long long load_evaluations = 0;
  long long faces = 0;    ///< faces or clusters summed in them; a sphere has none
  long long guarded = 0;  ///< load evaluations in which the passivity guard acted
  long long coarse =
      0;  ///< steps whose error stayed above the tolerance at the largest substep count
  long long rows = 0;      ///< constraint rows rewritten
  long long rejected = 0;  ///< steps whose result was not finite and was not taken over

  AmbientCounters& operator+=(const AmbientCounters& other);
};

/// One attached body: its model and what the solver hands to the action within a substep.
struct AmbientBody {
  btRigidBody* body = nullptr;  ///< may have been destroyed: look it up in a world first
  int instance = 0;             ///< instanceNumber() of the body that was attached
  AttachDef def;
  BodyModel model;
  Matrix6 basis_B = Matrix6::Identity();
  btScalar seen_inverse_mass = 0;  ///< dry mass properties the model was built from
  btVector3 seen_inverse_inertia{0, 0, 0};
  FlightMemory memory;
  Twist left_W;  ///< velocity after the last flight, world axes
  AmbientCounters counters;

  bool was_solved = false;  ///< the solver met the body in this substep
  bool is_adrift = false;   ///< no row has moved it in this substep
  bool was_coarse = false;  ///< the last flight's error stayed above the tolerance
  bool has_flown = false;   ///< free flight was computed in this substep and awaits the action
  int world_index = -1;     ///< where the body stood in its world's array when it was solved
  RigidState end;           ///< where it ends
  Twist end_W;              ///< its twist in world axes
  Twist effective_W;        ///< constant twist that Bullet integrates onto the end pose
  double length_scale = 0;  ///< lengths whose rounding the end position carries [m]
  Twist turning_W;          ///< turning part of the velocity that the rows were solved against
  Turn turn = Turn::kSlow;  ///< of a body with rows near
  double energy_bound =
      -1;  ///< twice the kinetic energy that rows may leave the body with [J]; < 0: none

  bool isInFluid() const { return def.medium.density > 0; }
};

/// Counts evaluations of the loads on a body.
inline void countLoads(AmbientBody& ambient, int evaluations) noexcept {
  ambient.counters.load_evaluations += evaluations;
  if (evaluations > 0)
    ambient.counters.faces += static_cast<long long>(evaluations) * ambient.model.loads->faces();
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

/// Makes the loads, and builds the model if the body is dynamic at present, or else when it next
/// is: until then, it has one of unit mass and inertia. What throws changes nothing.
/// @throws std::invalid_argument as makeSurfaceLoads() and makeBodyModel().
void refreshModel(AmbientBody& ambient, LoadTables& tables);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
