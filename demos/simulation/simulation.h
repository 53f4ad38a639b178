#pragma once

#include <btBulletDynamicsCommon.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bullet_ambient/fluid.h"
#include "bullet_ambient/immersed/wet_state.h"
#include "bullet_ambient/reading.h"
#include "bullet_ambient/saved_state.h"
#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/robots/robots_in_world.h"
#include "demos/simulation/scene_foils.h"
#include "demos/simulation/thrusters.h"
#include "demos/simulation/world_body.h"

namespace ambient {

/// Counts of Simulation::work() that summaries and Python show, by their names there;
/// AmbientCounters::energy_removed follows them.
constexpr std::array<std::pair<const char*, long long AmbientCounters::*>, 6> kWorkCounts{
    {{"substeps", &AmbientCounters::substeps},
     {"load_evaluations", &AmbientCounters::load_evaluations},
     {"guarded", &AmbientCounters::guarded},
     {"coarse", &AmbientCounters::coarse},
     {"too_long", &AmbientCounters::too_long},
     {"halted", &AmbientCounters::halted}}};

/// Lines of a drawn world.
struct WorldLines {
  std::vector<float> points;   ///< of both ends of each: x, y, z [m]
  std::vector<float> colours;  ///< of each: red, green, blue, from 0 to 1
};

/// All that changes of a simulation from step to step, in memory.
struct SimulationState {
  long long steps = 0;
  std::vector<ThrusterState> thrusters;
  std::vector<double> foil_angles;  ///< [rad]
  WorldState world;
};

/// Bullet world with the bodies of a scene in their fluid.
class Simulation {
 public:
  /// `bodies`: results of prepareBodies() for the scene. `takes_robots`: whether addRobots() may
  /// follow; contacts of scenes without robots then have other last bits. `flow`: wind or current
  /// beside that of the scene, everywhere; null: none.
  /// @throws std::invalid_argument naming the scene's file and the body if its values are not
  /// physical.
  Simulation(const Scene& scene, const std::vector<PreparedBody>& bodies, bool takes_robots = false,
             const FlowField& flow = nullptr);
  ~Simulation();

  /// Fluids of its Bullet world.
  Fluid& fluid() { return fluid_; }
  /// Whether its Bullet world is one for robots.
  bool takesRobots() const;
  /// Adds the robots that `scene` has more than the simulation, with their links. `bodies`: results
  /// of prepareBodies() for `scene`. @pre takesRobots(), and the rest of the scene is the same
  /// @throws std::invalid_argument or std::runtime_error in one line if a link or its settings are
  /// refused; then nothing was added
  void addRobots(const Scene& scene, const std::vector<PreparedBody>& bodies);
  /// A robot, in the order of the scene.
  SceneRobot& robot(std::size_t index) const { return robots_->robot(index); }

  /// Makes one step of scene.time_step.
  /// @throws std::runtime_error naming the scene's file, body and time if a state is not finite.
  void step();
  /// Makes one step without looking at its result.
  void stepUnchecked();
  /// Says, as step() would, which body is not finite; none: all are.
  std::optional<std::string> fault() const;

  /// Number of steps made so far times scene.time_step [s].
  double time() const { return static_cast<double>(steps_) * time_step_; }

  /// Present motion of all bodies, in the order of the scene.
  std::vector<MotionSample> sample() const;
  /// Present motion of one body. Allocates nothing.
  MotionSample sample(std::size_t body) const { return sample(bodies_.at(body)); }

  /// Thrusters of the scene; their commands are those of the scene at first.
  Thrusters& thrusters() { return thrusters_; }
  const Thrusters& thrusters() const { return thrusters_; }

  /// Foils of the scene likewise.
  SceneFoils& foils() { return foils_; }
  const SceneFoils& foils() const { return foils_; }

  /// Work done for one body by the fluid; zero for a body without fluid.
  AmbientCounters work(std::size_t body) const;

  /// Whether the wrench of the fluid on a body is kept, as Immersed::readWrench(). Without effect
  /// on a body without fluid.
  void readWrench(std::size_t body, bool is_read);
  /// Returns Immersed::wrench(); zero for a body without fluid.
  /// @throws std::logic_error if it is not read.
  FluidWrench wrench(std::size_t body) const;
  /// Returns Immersed::wet(); nothing for a body without fluid.
  WetState wet(std::size_t body) const;
  /// Returns Immersed::holds(); none of a body without fluid.
  std::vector<HoldWater> holds(std::size_t body) const;
  /// Handle of a body in its fluid, to fill its holds and change their openings.
  /// @throws std::invalid_argument naming the body if the fluid does not act on it
  const Immersed& vessel(std::size_t body) const;

  /// Adds a force [N] that acts at a point [m] during the next step; world axes.
  void applyForce(std::size_t body, const Vector3& force, const Vector3& point);
  /// Adds a wrench about the centre of mass that acts during the next step; world axes.
  void apply(std::size_t body, const Wrench& wrench) { apply(bodies_.at(body), wrench); }
  /// Adds a torque [N m] that acts during the next step; world axes.
  void applyTorque(std::size_t body, const Vector3& torque);

  /// Puts a rigid body elsewhere: its centre of mass, and the turn of the shape's axes to W.
  /// @throws std::invalid_argument if the body is a link.
  void setPose(std::size_t body, const Vector3& position, const Quaternion& orientation);
  /// Gives a rigid body a motion: velocity of its centre of mass, world axes.
  /// @throws std::invalid_argument if the body is a link.
  void setTwist(std::size_t body, const Twist& twist_W);
  /// Returns a robot whose motion is going to be set.
  SceneRobot& changedRobot(std::size_t index);

  /// Changes the fluid around a body, as Immersed::setMedium().
  /// @throws std::invalid_argument naming the body if the fluid does not act on it or the medium is
  /// not physical.
  void setMedium(std::size_t body, const Medium& medium);

  /// Multiplies mass and moments of inertia of a body.
  void scaleMass(std::size_t body, double mass, double moments);
  /// Sets the factors of Immersed::setFactors(); without effect on a body without fluid.
  void setFactors(std::size_t body, double added_mass, double loads);

  /// Multiplies the coefficient of friction of a body.
  void scaleFriction(std::size_t body, double factor);
  /// Moves the centre of mass within the body, from where it is after restore() of the start, by an
  /// offset in axes of the shape [m]; the body stays where it is, and the moments of inertia about
  /// the centre. Its pose is that of the new centre.
  /// @pre a rigid body that moves and has no joints; `prepared`: its own
  void moveCentre(std::size_t body, const PreparedBody& prepared, const Vector3& offset);
  /// Sets what a saved state has not of that: places of shapes, thrusters and foils.
  void setCentre(std::size_t body, const PreparedBody& prepared, const Vector3& offset);

  /// Medium of the fluid at the centre of mass of a body, as if the body were not there; of a body
  /// without fluid: a vacuum.
  Medium mediumAround(std::size_t body) const;
  /// Height of the surface of the water over a point, along the vertical [m]; infinite without one.
  double surfaceOver(const Vector3& point) const;
  /// Sum of the normal impulses of contacts on a body in the last step [N s].
  double contactImpulse(std::size_t body) const;

  /// Draws bodies, joints and what `drawing` selects, through Bullet's debug drawer.
  WorldLines lines(const FluidDrawing& drawing);

  /// Replaces water and regions by those of another scene, from the next step on.
  /// @throws std::invalid_argument or std::runtime_error, one sentence, if it has another number of
  /// them, or a body may not meet them.
  void setRegions(const Scene& scene);

  /// Serialises all that changes from step to step, including applied forces.
  std::string saveState() const;
  /// Goes on from there in this simulation or another one of the same scene, bit for bit where
  /// Fluid::restore() does.
  /// @throws std::runtime_error or std::invalid_argument, one sentence, if the bytes are damaged or
  /// of another scene; the simulation then stays as it was.
  void restoreState(std::string_view bytes);
  /// Copies all that changes from step to step, in memory, in microseconds.
  SimulationState state() const {
    return {steps_, thrusters_.states(), foils_.angles(), fluid_.save()};
  }
  /// Goes on from there, as restoreState(). @pre a state of this scene
  void restore(const SimulationState& state);

  /// All reports of the library, a sentence a line; empty: none.
  const std::string& warning() const { return warning_; }

 private:
  void add(const Scene& scene, const BodyDef& def, const PreparedBody& prepared);
  /// Takes bodies and robots from these numbers on out of the fluid and out of Bullet's world.
  void removeFrom(std::size_t body, std::size_t robot);
  void add(const JointDef& def);
  /// @throws std::runtime_error if no rigid body has this name.
  btRigidBody& find(const std::string& name) const;
  btMultiBody& multiBodyOf(const WorldBody& link) const;
  /// Fluids of the scene, with all that flows besides.
  std::vector<FluidRegion> regionsOf(const Scene& scene) const;
  /// Region that counts at a point; null: none.
  const FluidRegion* regionAt(const Vector3& point) const;
  /// Fluids at a point: of its region; without one the medium of a body, or a vacuum.
  RegionSample fluidAround(std::size_t body, const Vector3& point) const;
  btRigidBody& rigidBody(std::size_t body);
  /// Null: a link without a collider.
  btCollisionObject* objectOf(std::size_t body) const;
  /// True if what Bullet keeps of a body's motion is far from infinite, so that sample() is finite;
  /// false: perhaps it is not.
  bool isSound(std::size_t body) const;
  std::shared_ptr<const FluidBody> findFluidBody(const std::string& name) const;
  MotionSample sample(const WorldBody& of) const;
  /// Applies a wrench during the next step: about the centre of mass, axes of W.
  void apply(const WorldBody& to, const Wrench& wrench);
  void push();

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  BulletWorld bullet_;
  Fluid fluid_;
  FlowField flow_ = nullptr;        ///< beside the fluids of the scene, everywhere; null: none
  FlowField flow_above_ = nullptr;  ///< besides in fluids above a surface
  std::vector<RegionId> regions_;
  std::vector<FluidRegion> fluids_;  ///< as regions_
  std::vector<WorldBody> bodies_;
  std::unique_ptr<RobotsInWorld> robots_ = makeRobotsInWorld();  ///< null: built without
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  Thrusters thrusters_;
  SceneFoils foils_;
  LoadLaw own_law_;       ///< law of all bodies; empty: this library's law
  OwnFlight own_flight_;  ///< integrator of all bodies; null: the passive leapfrog
  double time_step_;
  std::string file_;  ///< file of the scene; begins every message
  std::string warning_;
  long long steps_ = 0;
};

}  // namespace ambient
