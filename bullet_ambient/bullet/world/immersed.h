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

/// Handle of a rigid body, or of a link of a btMultiBody, that Fluid::add() has put into a fluid.
/// Copies refer to the same member. Use it between steps.
///
/// All functions but isValid() and remove() throw std::logic_error, in one line, if the member was
/// removed, or if the Fluid or its world was destroyed. They need the body to be alive. A body that
/// is destroyed without remove() leaves an unused entry, which the next body at its address
/// replaces.
class Immersed {
 public:
  /// True if the member is still in the fluid. Does not access the body.
  bool isValid() const noexcept;

  /// Changes the fluid around the body, AttachDef::medium. The velocity of the body stays; the body
  /// wakes up if the medium differs. Cheap if density and viscosity stay: a current may be set in
  /// every step. @throws std::invalid_argument if the medium is not physical; then nothing has
  /// changed.
  void setMedium(const Medium& medium) const;
  /// Changes the fluid body, for example to scaled() of the old one after setLocalScaling() of the
  /// collision shape. `fluid_frame`: as in AttachDef; without this argument it stays. Set new mass
  /// properties before. @throws std::invalid_argument as Fluid::add(); then nothing has changed.
  void setFluidBody(std::shared_ptr<const FluidBody> fluid_body) const;
  void setFluidBody(std::shared_ptr<const FluidBody> fluid_body,
                    const FrameOffset& fluid_frame) const;

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

  /// Changes the velocity by an impulse at the centre of mass, world axes: torque part [N m s],
  /// force part [N s]. Uses the inverse of the total inertia, as contacts and joints do; for a
  /// link, that of its whole btMultiBody. Wakes the body.
  /// @throws std::invalid_argument if the mass properties of the body are not physical.
  void applyImpulse(const Wrench& impulse) const;

  /// Removes the member from its fluid; the body then moves as in stock Bullet. Returns false if it
  /// was removed before. Does not access the body, which may have been destroyed.
  bool remove() const;

 private:
  friend class Fluid;
  friend class WorldAttachment;
  Immersed(AmbientBodies& bodies, const AmbientBody& ambient);

  /// Members of the fluid while it exists, and the entry of this handle.
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
