#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>

#include "bullet_ambient/bullet/ambient_registry.h"
#include "bullet_ambient/bullet/fluid_drawing.h"
#include "bullet_ambient/bullet/precision_check.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Completes free flight after Bullet has moved the bodies. Add it to the world once:
/// world->addAction(&action). Forces are not applied here: an action runs after the solver, its
/// forces would be a substep late and lost in the last.
class AmbientAction : public btActionInterface {
 public:
  explicit AmbientAction(AmbientRegistry& registry) : registry_(registry) {}

  void updateAction(btCollisionWorld* world, btScalar time_step) override;

  /// What world->debugDrawWorld() draws of the fluid, for bodies that were in the world of the last
  /// step and still are. Nothing by default; costs nothing until then.
  FluidDrawing drawing;
  void debugDraw(btIDebugDraw* drawer) override;

 private:
  bool isSolverMissing(const btCollisionWorld& world, bool any_solved);

  AmbientRegistry& registry_;
  bool was_missing_ = false;
  const btCollisionWorld* world_ = nullptr;  // of the last step
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
