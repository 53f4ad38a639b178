#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/ambient_registry.h"
#include "bullet_ambient/bullet/fluid_drawing.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/world_attachment.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Completes free flight after Bullet has moved the bodies. Add it to the world once:
/// world->addAction(&action). Forces are not applied here: an action runs after the solver, its
/// forces would be a substep late and lost in the last.
class AmbientAction : public btActionInterface {
 public:
  explicit AmbientAction(AmbientRegistry& registry) : registry_(registry) {}

  void updateAction(btCollisionWorld* world, btScalar time_step) override;

  /// Keeps the world's bodies attached: WorldAttachment::update() at the end of every substep.
  void follow(std::unique_ptr<WorldAttachment> attachment);
  /// Forgets all that it follows.
  void followNothing() { followed_.clear(); }

  /// What world->debugDrawWorld() draws of the fluid around the bodies of that world, after its
  /// first step with this action. Nothing by default; costs nothing until then. An action that
  /// moves to another world must be stepped there before it draws again.
  FluidDrawing drawing;
  void debugDraw(btIDebugDraw* drawer) override;

 private:
  bool isSolverMissing(const btCollisionWorld& world);

  AmbientRegistry& registry_;
  std::vector<std::unique_ptr<WorldAttachment>> followed_;
  unsigned solved_ = 0;  // groups, until the last step
  bool was_missing_ = false;
  const btCollisionWorld* world_ = nullptr;  // of the last step
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
