#pragma once

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <BulletDynamics/MLCPSolvers/btSolveProjectedGaussSeidel.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/solver/fluid_solver.h"

namespace ambient::test {

using Members = std::shared_ptr<AmbientBodies>;  ///< what is in a fluid

// One type for each constraint solver of Bullet: `Ambient` is it with bodies in a fluid, `Stock`
// is Bullet's own. Both are constructed the same way.

template <class Solver>
struct SolverKind {
  using Base = Solver;
  struct Stock {
    Base solver;
  };
  struct Ambient {
    explicit Ambient(const Members& members) : solver(members) {}
    FluidSolver<Base> solver;
  };
};

using SequentialImpulse = SolverKind<btSequentialImpulseConstraintSolver>;
using ConjugateGradient = SolverKind<btNNCGConstraintSolver>;
using Multithreaded = SolverKind<btSequentialImpulseConstraintSolverMt>;
using MultiBody = SolverKind<btMultiBodyConstraintSolver>;

/// Contacts without extrapolation. Extrapolation can make a normal impulse negative. Bullet's
/// conjugate gradients then skip the contact's friction rows, and may end there. Stock bodies are
/// then wrong, too, by up to 500 times their velocity.
struct ConjugateGradientForJoints {
  using Base = btNNCGConstraintSolver;
  struct Stock {
    Stock() { solver.m_onlyForNoneContact = true; }
    Base solver;
  };
  struct Ambient {
    explicit Ambient(const Members& members) : solver(members) {
      solver.m_onlyForNoneContact = true;
    }
    FluidSolver<Base> solver;
  };
};

template <class Inner>
struct Complementarity {
  using Base = btMLCPSolver;
  struct Stock {
    Inner inner;
    Base solver{&inner};
  };
  struct Ambient {
    explicit Ambient(const Members& members) : solver(members, &inner) {}
    Inner inner;
    FluidSolver<Base> solver;
  };
};
using Dantzig = Complementarity<btDantzigSolver>;
using ProjectedGaussSeidel = Complementarity<btSolveProjectedGaussSeidel>;
using Lemke = Complementarity<btLemkeSolver>;

template <class Kind>
constexpr bool kIsComplementarity = std::is_same_v<typename Kind::Base, btMLCPSolver>;

/// Factor of the friction coefficient in the bound that Bullet's solver has for friction impulses.
enum class FrictionBound {
  kNormalImpulse,
  kFrictionlessNormalImpulse,  ///< normal impulse of a solution without friction
  kNothing,  ///< no factor: the coefficient is the bound. Bullet's Lemke solver is wrong by half of
             ///< the velocities where two bounds coincide: it needs friction.
};
template <class Kind>
inline constexpr FrictionBound kFrictionBound = FrictionBound::kNormalImpulse;
template <>
inline constexpr FrictionBound kFrictionBound<Dantzig> = FrictionBound::kFrictionlessNormalImpulse;
template <>
inline constexpr FrictionBound kFrictionBound<Lemke> = FrictionBound::kNothing;

using AllSolvers = ::testing::Types<SequentialImpulse, ConjugateGradient, Dantzig,
                                    ProjectedGaussSeidel, Lemke, Multithreaded, MultiBody>;

struct SolverName {
  template <class Kind>
  static std::string GetName(int) {
    if (std::is_same_v<Kind, SequentialImpulse>) return "SequentialImpulse";
    if (std::is_same_v<Kind, ConjugateGradient>) return "ConjugateGradient";
    if (std::is_same_v<Kind, ConjugateGradientForJoints>) return "ConjugateGradientForJoints";
    if (std::is_same_v<Kind, Dantzig>) return "Dantzig";
    if (std::is_same_v<Kind, ProjectedGaussSeidel>) return "ProjectedGaussSeidel";
    if (std::is_same_v<Kind, Lemke>) return "Lemke";
    if (std::is_same_v<Kind, Multithreaded>) return "Multithreaded";
    return "MultiBody";
  }
};

/// Arguments of a solver's solveGroup().
struct SolverTask {
  std::vector<btCollisionObject*> bodies;
  std::vector<btPersistentManifold*> manifolds;
  std::vector<btTypedConstraint*> joints;
  btContactSolverInfo info;
};

inline void solveOnce(btSequentialImpulseConstraintSolver& solver, SolverTask& task) {
  const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  solver.solveGroup(task.bodies.data(), count(task.bodies), task.manifolds.data(),
                    count(task.manifolds), task.joints.data(), count(task.joints), task.info,
                    nullptr, nullptr);
}

inline void solveOnce(btMultiBodyConstraintSolver& solver, SolverTask& task) {
  const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  solver.solveMultiBodyGroup(task.bodies.data(), count(task.bodies), task.manifolds.data(),
                             count(task.manifolds), task.joints.data(), count(task.joints), nullptr,
                             0, task.info, nullptr, nullptr);
}

/// Tells if a solver has converged. Complementarity: no fallback to sequential impulses. Iterative:
/// residual below the threshold of the settings, if there is one.
inline bool hasFinished(const btSequentialImpulseConstraintSolver& solver,
                        const btContactSolverInfo& info) {
  return !(info.m_leastSquaresResidualThreshold > 0) ||
         solver.m_analyticsData.m_remainingLeastSquaresResidual <=
             info.m_leastSquaresResidualThreshold;
}

inline bool hasFinished(const btMLCPSolver& solver, const btContactSolverInfo&) {
  return solver.getNumFallbacks() == 0;
}

}  // namespace ambient::test
