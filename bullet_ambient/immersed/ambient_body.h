#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/attach_def.h"
#include "bullet_ambient/immersed/fluid_models.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/motion/surface/flotation.h"

class btMultiBody;
class btRigidBody;

namespace ambient {

/// Outcome of a substep for a body or tree, from the solver; docs/bullet_step.md has the
/// transitions.
enum class Outcome : std::uint8_t {
  kNotSolved,  ///< the solver has not worked on it since the action took the last outcome; of a
               ///< tree also: it sleeps
  kStock,      ///< moves as in stock Bullet: not in a fluid, static, or of no physical mass
  kRows,       ///< moved by rows; a tree: by rows that turn with it (contacts, joints to bodies)
  kNoFlight,   ///< moved by no row and by no flight: locked axes, too fast a spin among rows, or a
               ///< failed flight
  kFlown,      ///< has flown, moved by no row; a tree: by none but those of its own joints
  kDisabled,   ///< moved by nothing: the substep has no finite duration
};

/// Data that the action needs to complete a motion by rows; docs/theory.md eq. (31).
struct RowMotion {
  Quaternion orientation = Quaternion::Identity();  ///< B to W, before Bullet moves the body
  Vector3 position = Vector3::Zero();               ///< of the centre of mass before that, with the
                                                    ///< position correction of the rows [m]
  Twist velocity_W;                                 ///< xi: Bullet moves it by xi and the flow
  Vector3 flow_W = Vector3::Zero();
  bool is_anchored =
      false;      ///< true: joints, or contacts with bodies that cannot move, hold the body
  Wrench load_W;  ///< mean surface load in the step, RowLoad
  /// Momentum relative to the flow, about the centre of mass at the start, which the turn keeps;
  /// none: a body with locked axes, or one that the fluid settles, eq. (124).
  std::optional<Momentum> momentum_W;
  /// Twice the kinetic energy allowed at the next pose [J]; infinite: no bound.
  double energy_bound = std::numeric_limits<double>::infinity();
};

/// Last free flight of a body: what the next one starts from, and what the action needs to complete
/// the present one.
struct LastFlight {
  Twist left_W;       ///< velocity of the body at the end, world axes
  Twist effective_W;  ///< constant twist that Bullet integrates onto the end pose
  FlightMemory memory;
  Quaternion orientation;  ///< end pose, see RigidState
  Vector3 position;
};

/// Effect of a substep on one body: written by the solver, taken once by the action.
struct SubstepOutcome {
  Outcome kind = Outcome::kNotSolved;
  bool is_too_long = false;  ///< true: with this flight the errors exceed StepErrors::kLargest
  int world_index = -1;  ///< index of the body in its world's array when the solver worked on it
  int activation_state =
      0;  ///< kDisabled: activation state to restore; meanwhile the body is disabled
  /// RowMotion: since rows have moved the body, for kRows and kNoFlight. It takes the place of the
  /// memory of the last flight, which is of no use then.
  std::variant<LastFlight, RowMotion> motion;

  /// The last surface load, world axes; 0: not known.
  const Wrench& lastLoad() const {
    const auto* flown = std::get_if<LastFlight>(&motion);
    return flown ? flown->memory.load_W : std::get<RowMotion>(motion).load_W;
  }
  RowMotion& rows() { return std::get<RowMotion>(motion); }
  const LastFlight& flight() const { return std::get<LastFlight>(motion); }
  /// The last flight; after a motion by rows, a new one without memory.
  LastFlight& flight() {
    if (auto* last = std::get_if<LastFlight>(&motion)) return *last;
    return motion.emplace<LastFlight>();
  }
};

/// Accumulated error E of a body's steps, as of a random walk that forgets old steps:
///
///   E^2 <- (1 - 1/n) E^2 + e^2
///
///   e  error of the velocity in a step, relative to the motion; 0 where it is within the tolerance
///   n  steps that count
class StepErrors {
 public:
  /// Limit of E above which the motion is visibly wrong. A box in water that chatters at 1/60 s has
  /// 0.06, and its path is off by 4 % after 3 s; a winged seed has 0.036 and is off by 0.6 %.
  static constexpr double kLargest = 0.05;

  /// Adds the error of a step. Returns true once: for the first step after which E exceeds
  /// kLargest.
  bool add(double error) noexcept {
    squares_ += error * error - squares_ / kSteps;
    if (was_large_ || !(squares_ > kLargest * kLargest)) return false;
    return was_large_ = true;
  }

 private:
  static constexpr double kSteps = 64;

  double squares_ = 0;  // E^2
  bool was_large_ = false;
};

struct WrenchSensor;

/// Body that a water surface may cut: its state there, from step to step.
struct FloatingState {
  SurfacePlane plane_W;  ///< surface at the start of the step
  Vector3 velocity_above = Vector3::Zero();
  WaveMemory waves;            ///< waves that the body has made
  WaveMemory waves_with_rows;  ///< waves after the step, if rows move the body
  Vector6 twist_before_rows =
      Vector6::Zero();  ///< velocity in B, relative to the water, that constraint rows start from
  SurfacePlane plane_before_rows;   ///< surface in B at the pose that rows start from
  Vector6 brake = Vector6::Zero();  ///< mean wrench in B by docs/theory.md eq. (68c), in a step in
                                    ///< which rows may move the body [N m, N]
  /// Last result of updateFlotations(). Its plane is that of the surface in B at the exact pose
  /// where the last flight or step with rows ended, before Bullet rounded it.
  Flotation flotation;
  bool has_plane = false;  ///< true: the plane of `flotation` is known
  bool is_valid = false;  ///< true: `flotation` belongs to its plane, and to the present models and
                          ///< surface

  void forgetPlane() noexcept { has_plane = false; }
  void setPlane(const SurfacePlane& plane_B) noexcept {
    flotation.plane = plane_B;
    has_plane = true;
    is_valid = false;
  }
};

/// Water in the holds of one body, from step to step.
struct VesselState {
  std::shared_ptr<const FluidBody> shape;
  bool is_known = false;         ///< false: the body has met no surface yet, and no water was given
  bool has_sunk = false;         ///< true: it was said that the body sinks
  std::vector<HoldState> holds;  ///< as in FluidBody::holds
  SurfacePlane plane_F{};        ///< of the surface near it at the start of this step
  RimRises rises;                ///< of waves at the openings in this step
  /// The region in this step if its waves are short against the body; null: `rises` does not count.
  const FluidRegion* waves = nullptr;
  WavesInside waves_inside;  ///< of the water in the holds at the openings in this step
  OpeningChanges changes;    ///< of openings while the body is in its fluid
  WaterInside inside;        ///< at FloatingState::flotation
  VesselSloshing sloshing;
  double sloshing_energy = 0;  ///< of VesselSloshing::now [J]
  WaterLeft before_rows;       ///< after it has sloshed for a step in which rows move the body
  /// Drag of the bodies in the holds, turned round, about the centre of mass, in the last step; and
  /// the largest speed of one past the vessel [m/s].
  Wrench reaction_W;
  double reaction_speed = 0;
  /// Change of the velocity in B by that and by the water that has come in at the start of this
  /// step.
  Vector6 change_B = Vector6::Zero();
};

/// Everything that the library keeps of one body or link in a fluid. Members lie in the order in
/// which a step uses them, so that a flight touches few lines of the cache; those that few steps or
/// few bodies use are last, or behind a pointer.
struct AmbientBody {
  btRigidBody* body = nullptr;         ///< null: a link. May have been destroyed: look it up in a
                                       ///< world first
  AmbientBody* next_solved = nullptr;  ///< next body in the list of AmbientBodies::takeSolved()
  int instance = 0;                    ///< instanceNumber() of the body that was attached
  int surface_media = -1;  ///< index into FluidModels::surfaces; -1: no surface is near the body
  std::shared_ptr<const MediumModel> in_medium;  ///< that of `medium`
  std::shared_ptr<WrenchSensor>
      sensor;                   ///< record for Immersed::wrench(); null: the wrench is not read
  bool may_rest = true;         ///< true: nothing around the body changes with time
  bool has_own_models = false;  ///< true: `models` are of this body alone, as its mass has changed;
                                ///< false: equal bodies share them
  /// Steps in a row in which a joint of the body was open by much of its size, at most 1000.
  std::int16_t open_joint_steps = 0;
  int in_hold = -1;  ///< index into FluidRegions::in_holds; -1: the body is in no hold of another
  SubstepOutcome outcome;  ///< in most steps the action needs only what precedes
                           ///< LastFlight::memory
  StepErrors step_errors;
  std::shared_ptr<const FluidModels> models;
  std::shared_ptr<const AttachDef> def;  ///< equal bodies without a name share it
  Medium medium;          ///< medium around the body now: its own, or that of its region; where no
                          ///< acceleration is given, with the one that FlowMemory tells
  double load_scale = 1;  ///< factor on the surface loads in this step, docs/theory.md eq. (51d),
                          ///< times AttachDef::load_factor
  RegionLocation location;  ///< kNone: the body is in its own medium
  FlowMemory flow;
  AmbientCounters counters;
  std::unique_ptr<FloatingState> floating;  ///< null: the body meets no surface
  std::unique_ptr<Wake> wake;  ///< wake behind a smooth body, docs/theory.md eq. (51b); null: no
                               ///< load on the body depends on it
  /// In this step; null: no region makes the fluid differ along the body.
  std::unique_ptr<FlowAlongBody> flow_along;
  /// Hull for layers, of the tables of the fluid body; null: a sphere, or no region has layers.
  const PackedHull* hull = nullptr;
  std::unique_ptr<VesselState> vessel;   ///< null: the body has no holds
  btMultiBody* multi_body = nullptr;     ///< that of a link; null: a rigid body
  std::shared_ptr<AmbientBody*> handle;  ///< where it is kept, for its Immersed: ends with it

  bool isInFluid() const { return medium.density > 0; }
  /// Model in the medium around the body.
  const BodyModel& model() const { return in_medium->model; }
  /// Model at the water surface near the body; null: no surface is near.
  const SurfaceModel* surface() const {
    if (surface_media < 0) return nullptr;
    return &models->surfaces[static_cast<std::size_t>(surface_media)].model;
  }
  /// Flotation at that surface: the last result of updateFlotations().
  const Flotation& flotation() const { return floating->flotation; }
  /// Model whose inertia K defines the norm sqrt(x.K x) of velocity changes.
  const BodyModel& metric() const { return surface() ? surface()->below : model(); }
};

/// Returns the states of the holds of a body; null: it has none.
inline const HoldState* waterOf(const AmbientBody& ambient) noexcept {
  return ambient.vessel ? ambient.vessel->holds.data() : nullptr;
}
/// Returns the same with the place for what is inside at the flotation of the body.
inline VesselWater waterAtFlotation(AmbientBody& ambient) noexcept {
  if (!ambient.vessel) return {};
  VesselState& vessel = *ambient.vessel;
  return {vessel.holds.data(), &vessel.inside, vessel.sloshing.modes.data(), &vessel.sloshing,
          ambient.def->holds.sloshing_damping};
}
/// Gives a body the holds of its definition, and the water from the start; it keeps what it has if
/// they are the same.
void setHolds(AmbientBody& ambient);
/// Gives a vessel a hole that its shape has not.
void addHole(const AddedHole& hole, VesselState& vessel);

/// Surface loads of the fluid around a body; at a water surface those of the fluid below. Null:
/// there are none.
inline const std::shared_ptr<const SurfaceLoads>& loadsOn(const AmbientBody& ambient) noexcept {
  const SurfaceModel* surface = ambient.surface();
  return surface ? surface->loads_below.loads : ambient.model().loads;
}

/// Adds a number of load evaluations, each at all stations, to the counters of a body.
inline void countLoads(AmbientBody& ambient, int evaluations) noexcept {
  if (evaluations == 0) return;
  const auto& loads = loadsOn(ambient);
  if (ambient.flow_along) evaluations *= std::max(1, ambient.flow_along->stations);
  ambient.counters.load_evaluations += evaluations;
  if (loads) ambient.counters.faces += static_cast<long long>(evaluations) * loads->faces();
}

/// True if the fluid differs along a body: addFlowAlong() adds something.
inline bool hasFlowAlong(const AmbientBody& ambient) noexcept {
  return ambient.flow_along && !ambient.flow_along->isNone();
}
/// Returns what the flow along a body adds to the applied wrench; world axes, about the centre of
/// mass.
Wrench pushByFlow(const AmbientBody& ambient, const Quaternion& orientation) noexcept;
/// Adds the flow along a body to its surroundings, if there is any.
void addFlowAlong(const AmbientBody& ambient, const Quaternion& orientation,
                  Surroundings& surroundings) noexcept;

/// Returns gravity, applied wrench and the flow around a body at the start of a step, without what
/// addFlowAlong() adds; world axes.
inline Surroundings surroundingsOf(const AmbientBody& ambient, const Vector3& gravity,
                                   const Wrench& applied) {
  return {gravity, applied, ambient.medium.velocity, ambient.medium.acceleration,
          ambient.load_scale};
}

/// Lets the wake of a smooth body follow its motion over a step of `duration` [s], and sets
/// `load_scale`; docs/theory.md eq. (51c), (51d).
void followWake(AmbientBody& ambient, const Twist& twist_W, double duration) noexcept;

/// Lets the next flight of a body begin without memory of the last one, and in a wake of its own.
void forgetFlight(AmbientBody& ambient) noexcept;
void forgetWake(AmbientBody& ambient) noexcept;

/// Forgets the waves that a body has made and where its surface was.
void forgetSurface(AmbientBody& ambient) noexcept;

/// Gives a body a handle, once it is where it is kept: that of the entry that it replaces (null:
/// none), whose name and reading it keeps, too.
void setHandle(AmbientBody& ambient, const AmbientBody* before);

/// Gives a body other models, of its present mass or an earlier one. It stays in its medium, and at
/// its surface unless they lack that.
void setModels(AmbientBody& ambient, std::shared_ptr<const FluidModels> models);

/// True if mass properties differ from those of the models: Bullet has got others.
inline bool isModelStale(const AmbientBody& ambient, const InverseMass& mass) {
  return !(ambient.models->inverse_mass == mass);
}

/// Makes the models again for another mass. From then on the body does not share them: the
/// first time allocates them.
/// @throws std::invalid_argument as setMass().
void rebuildModels(AmbientBody& ambient, const InverseMass& mass);

}  // namespace ambient
