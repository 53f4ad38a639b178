#include "bullet_ambient/bullet/world_kind.h"

#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <stdexcept>

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

void checkWorldKind(const std::string& who, const btDynamicsWorld& world) {
  switch (world.getWorldType()) {
    case BT_SIMPLE_DYNAMICS_WORLD:
      throw std::invalid_argument(
          who +
          ": btSimpleDynamicsWorld hands no bodies to its solver, so that no fluid can act; "
          "use btDiscreteDynamicsWorld");
    case BT_DEFORMABLE_MULTIBODY_DYNAMICS_WORLD:
      throw std::invalid_argument(
          who +
          ": btDeformableMultiBodyDynamicsWorld solves rigid bodies together with deformable "
          "ones in a way that cannot be rewritten; use btSoftRigidDynamicsWorld or "
          "btMultiBodyDynamicsWorld");
    default:
      return;
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
