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

AMBIENT_END
