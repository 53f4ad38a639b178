#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>

#include <memory>
#include <vector>

#include "bullet_ambient/attach_world.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/drawing.h"

class btCollisionWorld;

AMBIENT_BEGIN

class AmbientBodies;

/// Completes free flight after Bullet has moved the bodies, and draws. Forces are not applied here:
/// an action runs after the solver, its forces would be a substep late and lost in the last.
class FluidAction : public btActionInterface {
 public:
  /// Both must outlive the action. `drawing`: what debugDraw() draws.
  FluidAction(AmbientBodies& bodies, const FluidDrawing& drawing)
      : bodies_(bodies), drawing_(drawing) {}

  void updateAction(btCollisionWorld* world, btScalar time_step) override;
  void debugDraw(btIDebugDraw* drawer) override;

  /// Calls WorldAttachment::update() at the end of every substep from now on.
  void follow(std::unique_ptr<WorldAttachment> attachment);
  /// Adds bodies that have come to the world, as updateAction() does at its end.
  void attachLater(btCollisionWorld& world);
  /// Ends all follow().
  void followNothing() { followed_.clear(); }

 private:
  bool isSolverMissing(const btCollisionWorld& world);

  AmbientBodies& bodies_;
  const FluidDrawing& drawing_;
  std::vector<std::unique_ptr<WorldAttachment>> followed_;
  unsigned solved_ = 0;  // AmbientBodies::solved at the last step
  bool was_missing_ = false;
  const btCollisionWorld* world_ = nullptr;  // world of the last step
};

/// Finds which bodies and links of a world have their centre of mass in a hold of a vessel at a
/// surface of water, and the level there with what they displace: AmbientBody::in_hold of these,
/// and HoldState::displaced of the vessels, for the next substep. A body is in no hold that it is
/// larger than, and in the smallest vessel of several. Wakes what floats in a vessel that is awake.
/// Cost: 10 ns a body where none is smaller than the largest hold at a surface. Else a look at each
/// in the world, and the poses of links; the order from west to east of the smaller ones and of
/// vessels; for a body near a vessel the triangles of its holds; for a hold with bodies and water
/// some clips of all of them. Allocates nothing but for bodies that are new.
void findBodiesInHolds(btCollisionWorld& world, AmbientBodies& bodies) noexcept;

AMBIENT_END
