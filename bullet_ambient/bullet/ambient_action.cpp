#include "bullet_ambient/bullet/ambient_action.h"

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <utility>

#include "bullet_ambient/bullet/flight_coupling.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

namespace {

// Asks the world, not the registry: a body there may have been destroyed.
bool hasAwakeMember(const btCollisionWorld& world, const AmbientRegistry& registry) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const AmbientBody* ambient = registry.find(objects[i]);
    if (ambient && ambient->isInFluid() && objects[i]->isActive() &&
        !objects[i]->isStaticOrKinematicObject()) {
      return true;
    }
  }
  return false;
}

}  // namespace

// In two substeps in a row: another action may have woken the body after the solver's turn.
bool AmbientAction::isSolverMissing(const btCollisionWorld& world, bool any_solved) {
  const bool is_missing = !any_solved && registry_.size() > 0 && hasAwakeMember(world, registry_);
  return std::exchange(was_missing_, is_missing) && is_missing;
}

void AmbientAction::updateAction(btCollisionWorld* world, btScalar time_step) {
  bool any_solved = false;
  for (const auto& ambient : registry_.bodies()) {
    any_solved = any_solved || ambient->was_solved;
    ambient->was_solved = false;
    if (ambient->has_flown) endFlight(*ambient, static_cast<double>(time_step));
    if (std::exchange(ambient->is_adrift, false)) keepAwakeWhileMoving(*ambient);
  }
  if (isSolverMissing(*world, any_solved)) {
    registry_.complain(AmbientRegistry::Complaint::kNoSolver);
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
