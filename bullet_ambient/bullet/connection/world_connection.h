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

/// Solvers of a fluid that replace a world's plain ones: one solver, or a pool, and the one for
/// large islands of a multithreaded world. They continue the random numbers of the replaced ones.
class FittedSolvers {
 public:
  /// Makes the solvers; does not change the world.
  /// @throws std::invalid_argument, in one sentence that names makeSolver(), if the world has
  /// another solver than Bullet's plain ones, or a pool of others.
  FittedSolvers(btDiscreteDynamicsWorld& world, const std::shared_ptr<AmbientBodies>& members,
                SolverOwner owner);
  /// Deletes the solvers that nobody else has deleted.
  ~FittedSolvers();
  FittedSolvers(const FittedSolvers&) = delete;
  FittedSolvers& operator=(const FittedSolvers&) = delete;

  /// Gives the solvers to the world.
  void install(btDiscreteDynamicsWorld& world);
  /// Gives the world its own solvers back. A solver that somebody has given the world meanwhile
  /// stays.
  void giveBack(btDiscreteDynamicsWorld& world);
  /// True if the world solves with these solvers. Cost: a comparison of addresses.
  bool areIn(btDiscreteDynamicsWorld& world) const;

 private:
  struct DeleteIfAlive {
    std::weak_ptr<const void> life;
    void operator()(btConstraintSolver* solver) const;
  };
  using MadeSolver = std::unique_ptr<btConstraintSolver, DeleteIfAlive>;
  template <class Made>
  static MadeSolver hold(std::unique_ptr<Made> made);
  static MadeSolver makeFor(btDiscreteDynamicsWorld& world,
                            const std::shared_ptr<AmbientBodies>& members);

  // Solvers for all islands, and for large ones in multithreaded worlds; those of before, which may
  // have been deleted.
  MadeSolver made_, made_large_;
  btConstraintSolver* given_ = nullptr;
  btConstraintSolver* given_large_ = nullptr;
  bool owns_given_ = false;  // the world had made it itself
  SolverOwner owner_;
};

class AmbientBodies;

class FittedSolvers;
enum class SolverOwner;
struct WorldLife;

/// Gives a world fitting solvers and an action, and takes both back on destruction. World, solvers
/// and connection may be destroyed in any order: Bullet destroys the island manager with the world,
/// and one of a derived class reports that.
class WorldConnection {
 public:
  /// @throws std::invalid_argument with one sentence that begins with "Fluid: "; the world is then
  /// as it was.
  WorldConnection(btDynamicsWorld& world, const std::shared_ptr<AmbientBodies>& members,
                  btActionInterface& action, SolverOwner owner);
  ~WorldConnection();
  WorldConnection(const WorldConnection&) = delete;
  WorldConnection& operator=(const WorldConnection&) = delete;

  bool isWorldAlive() const;
  /// Fits new solvers if somebody has given the world another solver since.
  /// @throws as the constructor; world() if the world was destroyed
  void refit();

  /// @throws std::logic_error, in one sentence that begins with `who`, if it was destroyed.
  btDiscreteDynamicsWorld& world(const char* who) const;
  /// @throws as world(); std::invalid_argument if it is of another type.
  btMultiBodyDynamicsWorld& multiBodyWorld(const char* who) const;

 private:
  btDiscreteDynamicsWorld* world_;
  btActionInterface& action_;
  SolverOwner owner_;
  std::shared_ptr<WorldLife> life_;
  std::unique_ptr<FittedSolvers> solvers_;
};

AMBIENT_END
