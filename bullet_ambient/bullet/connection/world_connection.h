#pragma once

#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"

class btActionInterface;
class btConstraintSolver;
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

/// Gives a world a solver of the fluid in place of its plain one, whose random numbers it
/// continues, and an action; takes both back on destruction, before the world's.
class WorldConnection {
 public:
  /// @throws std::invalid_argument with one sentence that begins with "Fluid: ", and that names
  /// makeSolver() if the world has another solver than Bullet's plain ones; the world is then as it
  /// was.
  WorldConnection(btDynamicsWorld& world, const std::shared_ptr<AmbientBodies>& bodies,
                  btActionInterface& action, SolverOwner owner);
  /// Gives the world its own solver back; one that somebody has given it meanwhile stays.
  ~WorldConnection();
  WorldConnection(const WorldConnection&) = delete;
  WorldConnection& operator=(const WorldConnection&) = delete;

  /// Fits a new solver if somebody has given the world another solver since.
  /// @throws as the constructor
  void refit();

  btDiscreteDynamicsWorld& world() const { return world_; }
  bool isThreaded() const { return is_threaded_; }  ///< the world solves on several threads
  /// @throws std::invalid_argument, in one sentence that begins with `who`, if it is of another
  /// type.
  btMultiBodyDynamicsWorld& multiBodyWorld(const char* who) const;

 private:
  // Somebody else may delete the solver that was made.
  struct DeleteIfAlive {
    std::weak_ptr<const void> life;
    void operator()(btConstraintSolver* solver) const;
  };
  using MadeSolver = std::unique_ptr<btConstraintSolver, DeleteIfAlive>;

  MadeSolver makeFitting() const;
  void install(MadeSolver solver);
  void dropGiven();
  bool isFitted() const;

  btDiscreteDynamicsWorld& world_;
  const bool is_threaded_;
  btActionInterface& action_;
  SolverOwner owner_;
  const std::shared_ptr<AmbientBodies> bodies_;
  MadeSolver made_;
  btConstraintSolver* given_ = nullptr;  // that of before, which may have been deleted
  bool owns_given_ = false;              // the world had made it itself
};

AMBIENT_END
