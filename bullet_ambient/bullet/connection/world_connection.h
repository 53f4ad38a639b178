#pragma once

#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"

class btActionInterface;
class btDiscreteDynamicsWorld;
class btDynamicsWorld;
class btMultiBodyDynamicsWorld;

AMBIENT_BEGIN

class AmbientBodies;

/// How the owner of a world deletes its solver.
enum class SolverOwner {
  kKeepsPointer,  ///< by a pointer of its own
  /// By the pointer that it finds in the world, as PyBullet does when asked for another type of
  /// solver. If that is the fluid's solver, nobody else knows the replaced one: the fluid deletes
  /// it.
  kAsksWorld,
};

class FittedSolver;

/// Gives a world a fitting solver and an action, and takes both back on destruction, before the
/// world's.
class WorldConnection {
 public:
  /// @throws std::invalid_argument with one sentence that begins with "Fluid: "; the world is then
  /// as it was.
  WorldConnection(btDynamicsWorld& world, const std::shared_ptr<AmbientBodies>& members,
                  btActionInterface& action, SolverOwner owner);
  ~WorldConnection();
  WorldConnection(const WorldConnection&) = delete;
  WorldConnection& operator=(const WorldConnection&) = delete;

  /// Fits a new solver if somebody has given the world another solver since.
  /// @throws as the constructor
  void refit();

  btDiscreteDynamicsWorld& world() const { return world_; }
  /// @throws std::invalid_argument, in one sentence that begins with `who`, if it is of another
  /// type.
  btMultiBodyDynamicsWorld& multiBodyWorld(const char* who) const;

 private:
  btDiscreteDynamicsWorld& world_;
  btActionInterface& action_;
  SolverOwner owner_;
  const std::shared_ptr<AmbientBodies> members_;
  std::unique_ptr<FittedSolver> solver_;
};

AMBIENT_END
