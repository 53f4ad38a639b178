#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "bullet_ambient/bullet/attach_def.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/region_id.h"
#include "bullet_ambient/force/fluid_region.h"

class btDynamicsWorld;
class btMultiBody;
class btMultiBodyDynamicsWorld;
class btRigidBody;

namespace ambient {

class TaskRunner;

inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

class AmbientBodies;

/// Which bodies are in which fluid. Shared by one AmbientSolver (or several, with a multithreaded
/// world) and one AmbientAction; Fluid holds all three. Change it between steps only; it uses
/// neither user pointers nor callbacks of the world. What a region's flow or surface tries to
/// change while it is asked is refused: std::logic_error, and nothing has changed.
class AmbientRegistry {
 public:
  AmbientRegistry();
  ~AmbientRegistry();
  AmbientRegistry(const AmbientRegistry&) = delete;
  AmbientRegistry& operator=(const AmbientRegistry&) = delete;

  /// Puts a dynamic body of this world into a fluid; it may be added to the world before or after.
  /// @throws std::invalid_argument, saying what and the limit: a kind of world that cannot carry
  /// the fluid, static body, attached twice, no fluid body, mass, inertia, medium or flow settings
  /// that are not physical.
  void attach(const btDynamicsWorld& world, btRigidBody& body, AttachDef def);
  /// The same for a solver that is used without a world, which then cannot be checked.
  void attach(btRigidBody& body, AttachDef def);
  /// Takes the body out of its fluid; it then moves as in stock Bullet. False if nothing was
  /// attached at this address. It looks at nothing else, so that a body may be detached after it
  /// was destroyed, too; a body that is destroyed without leaves an entry that nothing reads and
  /// that the next body at its address replaces.
  bool detach(const btRigidBody& body);
  /// Detaches all bodies, alive or not.
  void clear();
  bool isAttached(const btRigidBody& body) const;

  /// Changes the fluid of an attached body, AttachDef::medium; its velocity stays, and it wakes up
  /// if anything did change. Cheap where density and viscosity stay: a current may be given in
  /// every step.
  /// @throws std::invalid_argument if the body is not attached or the medium is not physical.
  void setMedium(const btRigidBody& body, const Medium& medium);
  /// The fluid around it: that of its region, since its last step, or its own.
  const Medium& medium(const btRigidBody& body) const;

  /// Fills a part of the world with a fluid. Bodies whose AttachDef follows regions find it by
  /// themselves at the start of each step, and wake up at the end of the next. Regions that stay
  /// cost a body some comparisons of bounds, whose number grows like the logarithm of that of
  /// regions; without any, nothing. Cost: some microseconds; a fluid that no other region has is
  /// made known to every body that follows regions.
  /// @throws std::invalid_argument, naming value and limit, if bounds or media are not physical, or
  /// as attach() for a body that may meet them; then nothing has changed.
  RegionId addRegion(FluidRegion region);
  /// Replaces a region, say to move it. @throws as addRegion(), or if there is none.
  void setRegion(RegionId id, FluidRegion region);
  /// False if there is none.
  bool removeRegion(RegionId id);
  /// The region that the body was in at the start of its last step; kNone. @throws as medium().
  RegionId region(const btRigidBody& body) const;
  /// How long the world was stepped with its action [s]: the time of regions' functions.
  double time() const;

  /// Changes the shape of an attached body, say to scaled() of the old one after setLocalScaling()
  /// of its collision shape. `fluid_frame` as in AttachDef; without it, it stays. Set new mass
  /// properties before.
  /// @throws std::invalid_argument as attach(); the body then keeps its shape.
  void setFluidBody(const btRigidBody& body, std::shared_ptr<const FluidBody> fluid_body,
                    const FrameOffset& fluid_frame);
  void setFluidBody(const btRigidBody& body, std::shared_ptr<const FluidBody> fluid_body);

  /// Total inertia K in the body frame; docs/theory.md eq. (3). @throws as medium().
  Matrix6 inertia(const btRigidBody& body) const;

  /// Puts a link of a btMultiBody into a fluid, as attach() a body; -1 is the base. `fluid_frame`
  /// is in the link's frame: that of its centre of mass. The btMultiBody is finalized, and is or
  /// will be in this world, the only one with such links; docs/robots.md.
  /// @throws std::invalid_argument, saying what and the limit: no such link, attached twice, of
  /// another world, a fixed base, mass or settings as of a body, a btMultiBody that uses RK4.
  void attach(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body, int link, AttachDef def);
  /// As of a body; all links without a number. Looks at the address alone.
  bool detach(const btMultiBody& multi_body, int link);
  bool detach(const btMultiBody& multi_body);
  bool isAttached(const btMultiBody& multi_body, int link) const;
  void setMedium(const btMultiBody& multi_body, int link, const Medium& medium);
  void setFluidBody(const btMultiBody& multi_body, int link,
                    std::shared_ptr<const FluidBody> fluid_body, const FrameOffset& fluid_frame);
  const Medium& medium(const btMultiBody& multi_body, int link) const;
  RegionId region(const btMultiBody& multi_body, int link) const;
  /// In the link's frame.
  Matrix6 inertia(const btMultiBody& multi_body, int link) const;
  AmbientCounters counters(const btMultiBody& multi_body, int link) const;

  /// Bodies; links are not among them.
  std::size_t size() const;
  AmbientCounters counters(const btRigidBody& body) const;
  /// Of all bodies and links.
  AmbientCounters counters() const;

  /// Receives one sentence the first time something cannot be right: the action or the solver is
  /// missing from the world, a step's result was not finite, a body was attached whose moments of
  /// inertia no rigid body has, whose fluid body is empty, or that has less than half the mass of
  /// the medium it displaces, steps are so long that its motion is wrong by some per cent, or a
  /// joint of a body came apart step after step because the solver's iterations do not hold it; and
  /// one of each body that came later and was refused. Solvers on several threads report one after
  /// the other. What it throws is dropped. Default: standard error.
  void setReport(std::function<void(const std::string&)> report);

  /// Flies the bodies of one group of the solver on the runner's threads; they end with the same
  /// bits. Null (default): on the solver's thread. The runner must outlive its use here.
  void setTaskRunner(TaskRunner* runner);

 private:
  friend AmbientBodies& bodiesOf(const AmbientRegistry& registry);

  std::unique_ptr<AmbientBodies> bodies_;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
