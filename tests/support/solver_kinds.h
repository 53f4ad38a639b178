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

#include <string>
#include <type_traits>
#include <vector>

#include "bullet_ambient/bullet/ambient_solver.h"

namespace ambient::test {

// One type for each constraint solver of Bullet: `Ambient` is it with bodies in a fluid, `Stock`
// is Bullet's own. Both are constructed the same way.

template <class Solver>
struct SolverKind {
  using Base = Solver;
  struct Stock {
    Base solver;
  };
  struct Ambient {
    explicit Ambient(AmbientRegistry& registry) : solver(registry) {}
    AmbientSolver<Base> solver;
  };
};

using SequentialImpulse = SolverKind<btSequentialImpulseConstraintSolver>;
using ConjugateGradient = SolverKind<btNNCGConstraintSolver>;
using Multithreaded = SolverKind<btSequentialImpulseConstraintSolverMt>;
using MultiBody = SolverKind<btMultiBodyConstraintSolver>;

/// Contacts without extrapolation. Bullet's conjugate gradients skip the friction rows of a contact
/// whose impulse their extrapolation has made negative, and may end there: stock bodies too are
/// then wrong by up to 500 times their velocity.
struct ConjugateGradientForJoints {
  using Base = btNNCGConstraintSolver;
  struct Stock {
    Stock() { solver.m_onlyForNoneContact = true; }
    Base solver;
  };
  struct Ambient {
    explicit Ambient(AmbientRegistry& registry) : solver(registry) {
      solver.m_onlyForNoneContact = true;
    }
    AmbientSolver<Base> solver;
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
    explicit Ambient(AmbientRegistry& registry) : solver(registry, &inner) {}
    Inner inner;
    AmbientSolver<Base> solver;
  };
};
using Dantzig = Complementarity<btDantzigSolver>;
using ProjectedGaussSeidel = Complementarity<btSolveProjectedGaussSeidel>;
using Lemke = Complementarity<btLemkeSolver>;

/// What Bullet's solvers bound a friction impulse by, besides the coefficient of friction.
enum class FrictionBound {
  kNormalImpulse,
  kFrictionlessNormalImpulse,  ///< the normal impulse as it would be without friction
  kNothing,  ///< the coefficient is the bound. Bullet's Lemke solver, which moreover is wrong by
             ///< half of the velocities where two bounds coincide: it cannot do without friction.
};
template <class Kind>
inline constexpr FrictionBound kFrictionBound = FrictionBound::kNormalImpulse;
template <>
inline constexpr FrictionBound kFrictionBound<Dantzig> = FrictionBound::kFrictionlessNormalImpulse;
template <>
inline constexpr FrictionBound kFrictionBound<Lemke> = FrictionBound::kNothing;

using AllSolvers = ::testing::Types<SequentialImpulse, ConjugateGradient, Dantzig,
                                    ProjectedGaussSeidel, Lemke, Multithreaded, MultiBody>;

using SolversWithoutFriction = ::testing::Types<SequentialImpulse, ConjugateGradient, Dantzig,
                                                ProjectedGaussSeidel, Multithreaded, MultiBody>;

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

/// What a world hands to its solver.
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

/// Whether a solver has found what it looked for: a complementarity solver without handing over to
/// sequential impulses, an iterative one the residual that the settings ask for, if they do.
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
