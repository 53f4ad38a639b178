#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bullet_ambient/bullet/connection/fitted_solvers.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/solver/fluid_solver.h"
#include "bullet_ambient/bullet/world/fluid_drawing.h"
#include "bullet_ambient/bullet/world/immersed.h"
#include "bullet_ambient/bullet/world/world_attachment.h"
#include "bullet_ambient/force/medium/fluid_region.h"

class btCollisionObject;
class btDynamicsWorld;
class btMultiBody;
class btRigidBody;

namespace ambient {

class TaskRunner;
}  // namespace ambient

AMBIENT_BEGIN

class AmbientBodies;
class FluidAction;
class WorldConnection;
struct WorldState;

/// The fluids of one world and what is in them.
///
///     ambient::Fluid fluid(world);
///     fluid.addRegion(waterBelow(0));
///     fluid.add(body, {loadFluidBody("plate.ambient"), air()});
///
/// Change it between steps only; it uses neither user pointers nor callbacks of the world. What a
/// region's flow or surface tries to change while it is asked is refused: std::logic_error, and
/// nothing has changed.
///
/// Fluid, world, solvers and bodies may be destroyed in any order. With its world the fluid ends:
/// what is in it is removed, and functions that need the world throw std::logic_error.
class Fluid {
 public:
  /// Gives a btDiscreteDynamicsWorld, btMultiBodyDynamicsWorld, btSoftRigidDynamicsWorld or one
  /// derived from these the solver that fits it, in place of a plain
  /// btSequentialImpulseConstraintSolver, btMultiBodyConstraintSolver,
  /// btMultiBodyMLCPConstraintSolver or a pool of plain ones, and an action. For other solvers see
  /// makeSolver(). A world without bodies in a fluid moves bit for bit as before.
  /// @throws std::invalid_argument, in one sentence, if this kind of world cannot carry the fluid
  /// or has another solver; it is then as it was.
  explicit Fluid(btDynamicsWorld& world, SolverOwner owner = SolverOwner::kKeepsPointer);
  /// Takes everything out of its fluid, and gives the world its own solver back.
  ~Fluid();
  Fluid(const Fluid&) = delete;
  Fluid& operator=(const Fluid&) = delete;

  /// Whether its world has not been destroyed.
  bool isWorldAlive() const;
  /// Takes the place of a solver that somebody else has given the world since. To be called before
  /// each step of a world whose owner does that: costs a comparison where nothing has changed.
  /// @throws as the constructor; std::logic_error if the world was destroyed.
  void refit();

  /// Puts a dynamic body into a fluid, before or after it is added to the world.
  /// @throws std::invalid_argument, saying what and the limit: null, a static body, added twice, no
  /// fluid body, mass, inertia, medium or flow settings that are not physical.
  Immersed add(btRigidBody& body, AttachDef def);
  Immersed add(btRigidBody* body, AttachDef def);
  /// Puts a link of a btMultiBody into a fluid; -1 is its base. `fluid_frame` is in the link's
  /// frame: that of its centre of mass. The btMultiBody is finalized, and is or will be in this
  /// world; docs/robots.md.
  /// @throws std::invalid_argument, saying what and the limit: null, a world without multibodies,
  /// no such link, added twice, a fixed base, mass or settings as of a body, a btMultiBody that
  /// uses RK4.
  Immersed add(btMultiBody& multi_body, int link, AttachDef def);
  Immersed add(btMultiBody* multi_body, int link, AttachDef def);
  /// Puts all dynamic bodies of the world into a fluid, whatever their mass, and links of its
  /// multibodies that have a collider:
  ///
  ///     FluidBodyCache shapes;
  ///     const AttachReport report = fluid.addAll(shapes, water());
  ///
  /// Bodies that were added before stay as they are, so that several calls with filters may share
  /// out a world. What cannot be added is in the report. The source must outlive the fluid, or the
  /// next clear().
  AttachReport addAll(FluidBodySource& shapes, const Medium& medium, AttachSettings settings = {});
  /// Adds at once, before their first substep, bodies that have come since an addAll() with
  /// AttachSettings::later_bodies. Reports what is refused as a substep does.
  /// @throws std::logic_error if the world was destroyed.
  void addLaterBodies();

  /// The body or link if it was added: the one that is alive, never an earlier one at its address.
  std::optional<Immersed> find(const btRigidBody& body) const;
  std::optional<Immersed> find(const btMultiBody& multi_body, int link) const;
  /// Bodies and links.
  std::size_t size() const;
  /// Takes out all bodies and links, alive or not, and forgets the sources of addAll(). Regions
  /// stay.
  void clear();

  /// Fills a part of the world, or all of it, with a fluid, or with water below a surface and air
  /// above. Bodies whose AttachDef follows regions find it by themselves at the start of each step,
  /// and wake up at the end of the next. Regions that stay cost a body some comparisons of bounds,
  /// whose number grows like the logarithm of that of regions; without any, nothing. Cost: some
  /// microseconds; a fluid that no other region has is made known to every body that follows
  /// regions.
  /// @throws std::invalid_argument, naming value and limit, if bounds or media are not physical, or
  /// as add() for a body that may meet them; then nothing has changed.
  RegionId addRegion(FluidRegion region);
  /// Replaces a region, say to move it. @throws as addRegion(), or if there is none.
  void setRegion(RegionId id, FluidRegion region);
  /// False if there is none.
  bool removeRegion(RegionId id);

  /// Takes a picture of the world and its fluids between two steps; saved_state.h says what is in
  /// it.
  WorldState save() const;
  /// Puts the world back into a saved state, of which docs/bullet_step.md says when it then goes on
  /// bit for bit. The world has the same bodies, multibodies and joints in the same order: it is
  /// the same one, or was built by the same code, or loaded from a file. Adds and removes as
  /// needed; an Immersed of what is in the fluid before and after stays valid. Runs Bullet's
  /// collision detection once, with its callbacks, so that contacts have their places.
  /// @throws std::invalid_argument if the numbers of bodies, links or joints differ, a number is
  /// none that a world can have, a fluid body is missing or a medium is not physical; the world is
  /// then unchanged.
  void restore(const WorldState& state);

  /// Choice of what world.debugDrawWorld() draws, after the first step. Nothing by default;
  /// costs nothing until then.
  FluidDrawing drawing;

  /// Time for which the world was stepped [s], which regions' functions are given.
  double time() const;
  /// Sums the counters of all bodies and links.
  AmbientCounters counters() const;

  /// Receives one sentence the first time something cannot be right: the world has another solver,
  /// a step's result was not finite, a body was added whose moments of inertia no rigid body has,
  /// whose fluid body is empty, or that has less than half the mass of the medium it displaces,
  /// steps are so long that its motion is wrong by some per cent, or a joint of a body came apart
  /// step after step because the solver's iterations do not hold it; and one of each body that came
  /// later and was refused. Solvers on several threads report one after the other. What it throws
  /// is dropped. Default: standard error.
  void setReport(std::function<void(const std::string&)> report);
  /// Names a btRigidBody, or the collider of a link, in reports and errors: asked once for each
  /// body that is added later without AttachDef::name. Null (default), or an empty answer: bodies
  /// are called by their fluid body. What it throws comes out of add().
  void setNaming(std::function<std::string(const btCollisionObject&)> naming);
  /// Flies the bodies of one group of the solver on the runner's threads; they end with the same
  /// bits. Null (default): on the solver's thread. The runner must outlive its use here.
  void setTaskRunner(TaskRunner* runner);

 private:
  friend AmbientBodies& membersOf(const Fluid& fluid);
  template <class Base, class... Args>
  friend std::unique_ptr<FluidSolver<Base>> makeSolver(Fluid& fluid, Args&&... args);

  const std::shared_ptr<AmbientBodies> members_;
  const std::unique_ptr<FluidAction> action_;
  const std::unique_ptr<WorldConnection> connection_;
};

/// Makes a solver of the user's choice for the world of a fluid, or for a pool of it; arguments go
/// to Base. It may outlive the fluid, and then solves as Base does:
///
///     auto solver = makeSolver<btNNCGConstraintSolver>(fluid);
///     world.setConstraintSolver(solver.get());
template <class Base, class... Args>
std::unique_ptr<FluidSolver<Base>> makeSolver(Fluid& fluid, Args&&... args) {
  return std::make_unique<FluidSolver<Base>>(fluid.members_, std::forward<Args>(args)...);
}

AmbientBodies& membersOf(const Fluid& fluid);

AMBIENT_END
