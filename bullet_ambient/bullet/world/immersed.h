#pragma once

#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/member_slots.h"
#include "bullet_ambient/bullet/reading/wet_state.h"
#include "bullet_ambient/immersed/attach_def.h"
#include "bullet_ambient/immersed/region_id.h"

namespace ambient {

struct FluidWrench;
}  // namespace ambient

AMBIENT_BEGIN

class AmbientBodies;

/// A rigid body, or a link of a btMultiBody, in the fluid that Fluid::add() has put it into. Copies
/// name the same one. To be used between steps.
///
/// All functions but isValid() and remove() throw std::logic_error, in one line, if it was removed,
/// or if the Fluid or its world was destroyed. They need the body to be alive; a body that is
/// destroyed without remove() leaves an entry that nothing reads, and that the next body at its
/// address replaces.
class Immersed {
 public:
  /// Whether it is still in the fluid. Does not look at the body.
  bool isValid() const noexcept;

  /// Changes the fluid around it, AttachDef::medium; its velocity stays, and it wakes up if
  /// anything did change. Cheap where density and viscosity stay: a current may be given in every
  /// step. @throws std::invalid_argument if the medium is not physical; then nothing has changed.
  void setMedium(const Medium& medium) const;
  /// Changes its shape, say to scaled() of the old one after setLocalScaling() of its collision
  /// shape. `fluid_frame` as in AttachDef; without it, it stays. Set new mass properties before.
  /// @throws std::invalid_argument as Fluid::add(); it then keeps its shape.
  void setFluidBody(std::shared_ptr<const FluidBody> fluid_body) const;
  void setFluidBody(std::shared_ptr<const FluidBody> fluid_body,
                    const FrameOffset& fluid_frame) const;

  /// The fluid around it, that of its region or its own: when it was added, or at the start of its
  /// last step.
  Medium medium() const;
  /// The region of that fluid; kNone: its own.
  RegionId region() const;
  /// Total inertia K in the frame of the body or link; docs/theory.md eq. (3).
  Matrix6 inertia() const;
  AmbientCounters counters() const;

  /// Whether the wrench of the fluid is kept from the next substep on. At first it is not: then
  /// nothing of it is computed or stored.
  void readWrench(bool is_read) const;
  /// The wrench by part, of reading.h, in its last substep, while it was awake; zero before the
  /// first one, and in no fluid.
  /// @throws std::logic_error if it is not read.
  FluidWrench wrench() const;
  /// Its wet part where it is now. Asks its region, and takes a sum over the triangles of its
  /// shape.
  WetState wet() const;

  /// Changes its velocity by an impulse, torque [N m s] and force [N s] at its centre of mass, both
  /// in world axes; as contacts and joints do, by the inverse of the total inertia, or of that of
  /// all links of its btMultiBody. Wakes it.
  /// @throws std::invalid_argument if its mass properties are not physical.
  void applyImpulse(const Wrench& impulse) const;

  /// Takes it out of its fluid; it then moves as in stock Bullet. False if it was removed before.
  /// Does not look at the body, which may have been destroyed.
  bool remove() const;

 private:
  friend class Fluid;
  friend class WorldAttachment;
  Immersed(AmbientBodies& bodies, const AmbientBody& ambient);

  /// The fluid, while it lives.
  struct Held {
    std::shared_ptr<AmbientBodies> bodies;
    Member member;
  };
  Held hold() const noexcept;
  Held require(const char* function) const;

  std::weak_ptr<AmbientBodies> bodies_;
  MemberId id_;
};

AMBIENT_END
