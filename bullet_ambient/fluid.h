#pragma once

// Fluid, the fluids of one world, and Immersed, a body or link in one.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/attach_world.h"
#include "bullet_ambient/base/task_runner.h"
#include "bullet_ambient/bullet/connection/world_connection.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/solver/fluid_solver.h"
#include "bullet_ambient/drawing.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/attach_def.h"
#include "bullet_ambient/immersed/wet_state.h"

class btCollisionObject;
class btDynamicsWorld;
class btMultiBody;
class btRigidBody;

namespace ambient {

struct AmbientBody;
struct FluidWrench;

}  // namespace ambient

AMBIENT_BEGIN

class AmbientBodies;

/// Handle of a rigid body, or of a link of a btMultiBody, that Fluid::add() has put into a fluid.
/// Copies refer to the same body or link. Use it between steps.
///
/// All functions but isValid() and remove() throw std::logic_error, in one line, if the body or
/// link was removed, or if the Fluid was destroyed. They need the body to be alive. A body that is
/// destroyed without remove() leaves an unused entry, which the next body at its address replaces.
class Immersed {
 public:
  /// True if the body or link is still in the fluid. Does not access the body.
  bool isValid() const noexcept;

  /// Changes the fluid around the body, AttachDef::medium. The velocity of the body stays; the body
  /// wakes up if the medium differs. Cheap if density and viscosity stay: a current may be set in
  /// every step. @throws std::invalid_argument if the medium is not physical; then nothing has
  /// changed.
  void setMedium(const Medium& medium) const;
  /// Changes the fluid body, for example to scaled() of the old one after setLocalScaling() of the
  /// collision shape. `fluid_frame`: as in AttachDef; none: it stays. Set new mass properties
  /// before. @throws std::invalid_argument as Fluid::add(); then nothing has changed.
  void setFluidBody(std::shared_ptr<const FluidBody> fluid_body,
                    const std::optional<FrameOffset>& fluid_frame = std::nullopt) const;

  /// Sets AttachDef::added_mass_factor and AttachDef::load_factor. The velocity of the body stays;
  /// the waves that it has made, sloshing and the last load are forgotten.
  /// Cost: new models, some microseconds; no loads.
  /// @throws std::invalid_argument if one is not positive and finite; then nothing has changed.
  void setFactors(double added_mass, double loads) const;

  /// Returns the fluid around the body, that of its region or its own, at the start of its last
  /// step; before the first step, when it was added. Its acceleration is the one given, or that by
  /// which a velocity without one has changed since the step before.
  Medium medium() const;
  /// Returns the fluid body, AttachDef::fluid_body.
  std::shared_ptr<const FluidBody> fluidBody() const;
  /// Returns the region of medium(); kNone: the own medium of the body.
  RegionId region() const;
  /// Returns the total inertia K of body and fluid, in the frame of the body or link, rotation
  /// first; docs/theory.md eq. (3).
  Matrix6 inertia() const;
  /// Returns the kinetic energy of the body, and of the fluid relative to the ambient flow, for the
  /// present velocity [J].
  double kineticEnergy() const;
  AmbientCounters counters() const;

  /// Switches the reading of the wrench on or off. Off at first: then nothing is computed or stored
  /// for it.
  void readWrench(bool is_read) const;
  /// Returns the wrench of the fluid by part (reading.h) in the last substep in which the body was
  /// awake; zero outside of any fluid. Before the first substep with reading: that of the pose and
  /// velocity when it was switched on, without added mass and constraints.
  /// @throws std::logic_error if it is not read.
  FluidWrench wrench() const;
  /// Returns the wet part at the present pose. Cost: functions of the region, and a sum over the
  /// triangles of the shape.
  WetState wet() const;

  /// Returns the water in the holds at the present pose, FluidBody::holds; away from a surface of
  /// water, what they will have there. Cost: some clips of the surface of each hold.
  std::vector<HoldWater> holds() const;
  /// Fills or empties a hold [m^3]; the velocity stays. Wakes the body.
  /// @throws std::invalid_argument if there is no such hold, or if the water does not fit.
  void setWater(int hold, double volume) const;
  /// Pumps water from the sea into a hold, or out of it (negative), in each step at a surface until
  /// another rate is set [m^3/s]. Wakes the body. @throws std::invalid_argument if there is no such
  /// hold, or if the rate is not finite.
  void pump(int hold, double rate) const;

  /// Shuts or opens an opening of a hold: doors, hatches, valves, ramps. Its number is that in
  /// Hold::openings, and those that addOpening() has returned follow. Wakes the body.
  /// @throws std::invalid_argument if there is no such hold or opening
  void setOpening(int hold, int opening, bool is_open) const;
  /// Makes a round hole from a hold to the fluid outside: damage, scuppers. Returns its number
  /// among the openings of the hold. It stays until setFluidBody(), shape and mass do not change.
  /// Wakes the body.
  /// @param hold number in FluidBody::holds
  /// @param place of its middle, in the frame of the fluid body [m]
  /// @param normal out of the hold, in that frame; of any length
  /// @param area [m^2]
  /// @throws std::invalid_argument if there is no such hold, or if place, normal or area are no
  /// place of the body, direction and area
  int addOpening(int hold, const Vector3& place, const Vector3& normal, double area) const;

  /// Changes the velocity by an impulse at the centre of mass, world axes: torque part [N m s],
  /// force part [N s]. Uses the inverse of the total inertia, as contacts and joints do; for a
  /// link, that of its whole btMultiBody. Wakes the body.
  /// @throws std::invalid_argument if the mass properties of the body are not physical.
  void applyImpulse(const Wrench& impulse) const;

  /// Removes the body or link from its fluid; it then moves as in stock Bullet. Returns false if it
  /// was removed before. Does not access the body, which may have been destroyed.
  bool remove() const;

 private:
  friend class Fluid;
  Immersed(AmbientBodies& bodies, const AmbientBody& ambient);

  /// Bodies of the fluid, kept while they are in use, and the body or link of this handle; null: it
  /// was removed.
  struct Access {
    std::shared_ptr<AmbientBodies> bodies;
    AmbientBody* ambient;
  };
  Access lock() const noexcept;
  Access require(const char* function) const;
  /// Access for a function that changes what is asked for the fluid.
  Access requireChangeable(const char* function) const;

  std::weak_ptr<AmbientBodies> bodies_;
  std::weak_ptr<AmbientBody*> handle_;
};

class FluidAction;
class WorldConnection;
struct WorldState;

/// The fluids of one Bullet world, and the bodies and links in them.
///
///     ambient::Fluid fluid(world);
///     fluid.addRegion(waterBelow(0));
///     fluid.add(body, {loadFluidBody("plate.ambient"), air()});
///
/// Call its functions between steps only. It uses neither user pointers nor callbacks of the world.
/// The flow or surface function of a region must not change the fluid: such a call throws
/// std::logic_error and changes nothing.
///
/// Destroy a Fluid before its world; its bodies before or after it.
class Fluid {
 public:
  /// Gives a btDiscreteDynamicsWorld, btMultiBodyDynamicsWorld, btSoftRigidDynamicsWorld or one
  /// derived from these the solver that fits it, in place of a plain
  /// btSequentialImpulseConstraintSolver, btMultiBodyConstraintSolver,
  /// btMultiBodyMLCPConstraintSolver, and an action. For other solvers, and pools of several, see
  /// makeSolver(). A world without bodies in a fluid moves bit for bit as before.
  /// @throws std::invalid_argument, in one sentence, if this kind of world is not supported or has
  /// another solver; the world is then unchanged.
  explicit Fluid(btDynamicsWorld& world, SolverOwner owner = SolverOwner::kKeepsPointer);
  /// Removes all bodies and links, and gives the world its own solver back.
  ~Fluid();
  Fluid(const Fluid&) = delete;
  Fluid& operator=(const Fluid&) = delete;

  /// Replaces a solver that somebody else has given the world since. Call before each step if the
  /// owner of the world does that. Cost if nothing has changed: a comparison.
  /// @throws as the constructor
  void refit();

  /// Puts a dynamic body into a fluid, before or after it is added to the world.
  /// @throws std::invalid_argument, saying what and the limit: a static body, added twice, no
  /// fluid body, mass, inertia, medium or flow settings that are not physical.
  Immersed add(btRigidBody& body, AttachDef def);
  /// Puts a link of a btMultiBody into a fluid; -1 is its base. `fluid_frame` is in the link's
  /// frame: that of its centre of mass. The btMultiBody is finalized, and is or will be in this
  /// world; docs/robots.md. In place of a link without mass the link with mass is added that fixed
  /// joints hold to it.
  /// @throws std::invalid_argument, saying what and the limit: a world without multibodies,
  /// no such link, added twice, a fixed base, mass or settings as of a body, a btMultiBody that
  /// uses RK4.
  Immersed add(btMultiBody& multi_body, int link, AttachDef def);
  /// Puts all dynamic bodies of the world into a fluid, whatever their mass, and all links of its
  /// multibodies that have a collider:
  ///
  ///     FluidBodyCache shapes;
  ///     const AttachReport report = fluid.addAll(shapes, water());
  ///
  /// Bodies that were added before do not change: several calls with filters may divide a world.
  /// The report lists what could not be added. `shapes` must outlive the fluid or the next clear().
  AttachReport addAll(FluidBodySource& shapes, const Medium& medium, AttachSettings settings = {});
  /// Adds bodies that have come to the world since an addAll() with AttachSettings::later_bodies,
  /// at once, before their first substep. Refusals go to the report function, as at the end of a
  /// substep.
  void addLaterBodies();

  /// Finds a body or link that was added; never confuses it with an earlier one at the same
  /// address.
  std::optional<Immersed> find(const btRigidBody& body) const;
  std::optional<Immersed> find(const btMultiBody& multi_body, int link) const;
  /// Number of bodies and links in the fluid.
  std::size_t size() const;
  /// Removes all bodies and links, alive or not, and forgets the sources of addAll(). Regions stay.
  void clear();

  /// Fills a part of the world, or all of it, with a fluid, or with water below a surface and air
  /// above. Bodies with AttachDef::follow_regions find their region at the start of each step;
  /// sleeping ones wake up at the end of the next step. Cost per body and step: O(log(number of
  /// regions)) comparisons of bounds. Cost of this call: some microseconds; if no other region has
  /// this fluid, also new loads for every body that follows regions.
  /// @throws std::invalid_argument, naming value and limit, if bounds or media are not physical, or
  /// as add() for a body that may meet them; then nothing has changed.
  RegionId addRegion(FluidRegion region);
  /// Replaces a region, for example to move it. @throws as addRegion(), or if there is no such
  /// region.
  void setRegion(RegionId id, FluidRegion region);
  /// Removes a region. Returns false if there is no such region.
  bool removeRegion(RegionId id);

  /// Copies the state of the world and its fluids between two steps; saveState() lists what is
  /// included.
  WorldState save() const;
  /// Restores a saved state, see restoreState(). Adds and removes bodies as needed; the Immersed
  /// of one that is in the fluid before and after stays valid.
  /// @throws std::invalid_argument as restoreState(); the world is then unchanged.
  void restore(const WorldState& state);

  /// Selects what world.debugDrawWorld() draws after the first step. Default: nothing, without
  /// cost.
  FluidDrawing drawing;

  /// Sum of all steps of the world so far [s]; the time that functions of regions get.
  double time() const;
  /// Sums the counters of all bodies and links.
  AmbientCounters counters() const;

  /// Sets the function that receives reports. It gets one sentence the first time each of these
  /// happens: the world has another solver; the result of a step is not finite; a body is added
  /// whose moments of inertia no rigid body can have, whose fluid body is empty, or that has less
  /// than half the mass of the medium it displaces; steps are so long that the motion is wrong by
  /// some per cent; a joint comes apart step after step because the solver's iterations do not hold
  /// it. It also gets one sentence for each later body that is refused. Solvers on several threads
  /// report one after the other. The function must not remove bodies or links while the world
  /// steps. Its exceptions are dropped. Default: standard error.
  void setReport(std::function<void(const std::string&)> report);
  /// Sets the function that names a btRigidBody, or the collider of a link, in reports and errors.
  /// It is called once for each body that is added from now on without AttachDef::name. Null
  /// (default), or an empty name: the body is called by its fluid body. Its exceptions pass through
  /// add().
  void setNaming(std::function<std::string(const btCollisionObject&)> naming);
  /// Spreads the flights of free bodies over the threads of a runner; results have the same bits.
  /// Null (default): flights run on the thread of the solver. threads.h has that of Bullet.
  void setTaskRunner(TaskRunner runner);

 private:
  friend AmbientBodies& ambientBodiesOf(const Fluid& fluid);
  friend void stepTogether(Fluid* const* fluids, int count, const std::function<void(int)>& step);
  template <class Base, class... Args>
  friend std::unique_ptr<FluidSolver<Base>> makeSolver(Fluid& fluid, Args&&... args);

  const std::shared_ptr<AmbientBodies> bodies_;
  const std::unique_ptr<FluidAction> action_;
  const std::unique_ptr<WorldConnection> connection_;
};

/// Makes a solver of the user's choice for the world of a fluid, or for a solver pool; `args` go to
/// the constructor of Base. The solver may outlive the fluid, and then solves as Base does:
///
///     auto solver = makeSolver<btNNCGConstraintSolver>(fluid);
///     world.setConstraintSolver(solver.get());
template <class Base, class... Args>
std::unique_ptr<FluidSolver<Base>> makeSolver(Fluid& fluid, Args&&... args) {
  return std::make_unique<FluidSolver<Base>>(fluid.bodies_, std::forward<Args>(args)...);
}

AmbientBodies& ambientBodiesOf(const Fluid& fluid);

/// Makes one step of each of several worlds, with the bits that it has alone. Bodies of all worlds
/// that touch nothing fly side by side, up to eight at a time, as those of one world do; cost of a
/// flight: less than half.
///
///     stepTogether(fluids, 8, [&](int i) { worlds[i]->stepSimulation(h, 0); });
///
/// Each step runs within the one before it, where rows are solved and bodies have not moved yet.
/// @param fluids of the worlds, one each
/// @param count of worlds
/// @param step makes a step of world i, if it likes with all that belongs to it; must not throw,
/// nor use the other worlds
/// @throws std::invalid_argument if a world solves on several threads; then nothing has moved
void stepTogether(Fluid* const* fluids, int count, const std::function<void(int)>& step);

AMBIENT_END
