#pragma once

#include <string>

#include "bullet_ambient/bullet/precision_check.h"

class btActionInterface;
class btConstraintSolver;
class btDynamicsWorld;
class btMultiBodyDynamicsWorld;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// @throws std::invalid_argument, in one sentence that begins with `who`, if no fluid can act in
/// worlds of this kind.
void checkWorldKind(const std::string& who, const btDynamicsWorld& world);

/// Ties one world to a solver and an action, which must be alive while it is stepped.
class WorldTie {
 public:
  /// @throws std::invalid_argument with one sentence; the world is then as it was.
  void tie(btDynamicsWorld& world, btConstraintSolver& solver, btActionInterface& action);
  /// Forgets the world, and does not look at it: it may have been destroyed.
  void forget() { *this = {}; }
  /// @throws std::invalid_argument, in one sentence, if it is tied to none that has multibodies.
  btMultiBodyDynamicsWorld& multiBodyWorld() const;

 private:
  const btDynamicsWorld* world_ = nullptr;
  btMultiBodyDynamicsWorld* multibody_world_ = nullptr;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
