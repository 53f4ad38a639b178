#pragma once

#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <memory>
#include <utility>

#include "bullet_ambient/bullet/ambient_action.h"
#include "bullet_ambient/bullet/ambient_solver.h"
#include "bullet_ambient/bullet/fluid_body_source.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/world_attachment.h"
#include "bullet_ambient/bullet/world_tie.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The fluids of one world: registry, solver and action in one. Base: Bullet's solver, as for
/// AmbientSolver; btMultiBodyConstraintSolver for a btMultiBodyDynamicsWorld.
///
/// Fluid, world and bodies may be destroyed in any order: none looks at another one then. As with
/// any solver of Bullet's, a world must not be stepped after its fluid was destroyed, unless the
/// action was removed from it and it was given another solver before.
template <class Base = btSequentialImpulseConstraintSolver>
class Fluid {
 public:
  /// Arguments go to Base.
  template <class... Args>
  explicit Fluid(Args&&... args) : solver_(registry_, std::forward<Args>(args)...) {}
  Fluid(const Fluid&) = delete;
  Fluid& operator=(const Fluid&) = delete;

  /// To construct the world with.
  AmbientSolver<Base>& solver() { return solver_; }
  /// To change media and shapes, and to read counters.
  AmbientRegistry& registry() { return registry_; }
  const AmbientRegistry& registry() const { return registry_; }
  /// To choose what is drawn.
  AmbientAction& action() { return action_; }

  /// Gives the world this solver and action; again without harm. A btConstraintSolverPoolMt stays:
  /// its solvers are AmbientSolvers of registry().
  /// @throws std::invalid_argument, in one sentence, if the fluid is attached to another world, or
  /// this kind of world cannot carry the fluid or does not go with Base.
  void attachTo(btDynamicsWorld& world) { tie_.tie(world, solver_, action_); }

  /// attachTo(world), and puts all its dynamic rigid bodies into a fluid, whatever their mass:
  ///
  ///     FluidBodyCache shapes;
  ///     const AttachReport report = fluid.attachAll(world, shapes, water());
  ///
  /// Bodies that are attached already stay as they are, so that several calls with filters may
  /// share out a world. What cannot be attached is in the report. The source must outlive the
  /// fluid, or the next clear().
  /// @throws std::invalid_argument as attachTo().
  AttachReport attachAll(btDynamicsWorld& world, FluidBodySource& shapes, const Medium& medium,
                         AttachSettings settings = {}) {
    attachTo(world);
    const bool later_bodies = settings.later_bodies;
    auto attachment =
        std::make_unique<WorldAttachment>(registry_, shapes, medium, std::move(settings));
    AttachReport report = attachment->attachNew(world);
    if (later_bodies || report.attached > 0) action_.follow(std::move(attachment));
    return report;
  }

  /// Puts a dynamic body into a fluid, before or after it is added to the world.
  /// @throws std::invalid_argument as AmbientRegistry::attach().
  void add(btRigidBody& body, AttachDef def) { registry_.attach(body, std::move(def)); }
  /// Puts a link of a btMultiBody into a fluid; -1 is its base. Base has to be a solver of
  /// multibodies; docs/robots.md. @pre attachTo()
  /// @throws std::invalid_argument as AmbientRegistry::attach(), or without a world.
  void add(btMultiBody& multi_body, int link, AttachDef def) {
    registry_.attach(tie_.multiBodyWorld(), multi_body, link, std::move(def));
  }
  /// Fills a part of the world, or all of it, with a fluid, or with water below a surface and air
  /// above. @throws std::invalid_argument as AmbientRegistry::addRegion().
  RegionId addRegion(FluidRegion region) { return registry_.addRegion(std::move(region)); }
  /// As AmbientRegistry::setRegion() and removeRegion().
  void setRegion(RegionId id, FluidRegion region) { registry_.setRegion(id, std::move(region)); }
  bool removeRegion(RegionId id) { return registry_.removeRegion(id); }
  /// As AmbientRegistry::detach().
  bool remove(const btRigidBody& body) { return registry_.detach(body); }
  bool remove(const btMultiBody& multi_body, int link) {
    return registry_.detach(multi_body, link);
  }
  bool remove(const btMultiBody& multi_body) { return registry_.detach(multi_body); }
  /// Removes all bodies, and lets go of the world: all of them may have been destroyed. Where the
  /// world lives on, it goes on with this solver, without fluid until a body is added.
  void clear() {
    registry_.clear();
    action_.followNothing();
    tie_.forget();
  }

 private:
  AmbientRegistry registry_;
  AmbientSolver<Base> solver_;
  AmbientAction action_{registry_};
  WorldTie tie_;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
