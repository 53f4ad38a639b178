#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>

#include "bullet_ambient/bullet/ambient_registry.h"
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
  void debugDraw(btIDebugDraw*) override {}

 private:
  bool isSolverMissing(const btCollisionWorld& world, bool any_solved);

  AmbientRegistry& registry_;
  bool was_missing_ = false;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
