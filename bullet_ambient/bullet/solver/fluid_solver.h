#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"
#include "bullet_ambient/bullet/solver/solver_group.h"

class btMLCPSolver;
class btMultiBodyConstraintSolver;
class btMultiBodyMLCPConstraintSolver;
class btSequentialImpulseConstraintSolverMt;
class btDeformableMultiBodyConstraintSolver;

AMBIENT_BEGIN

class AmbientBodies;

/// Constraint solver of Bullet, derived from Base, whose contacts and joints feel the full 6x6
/// inertia of ambient bodies by a change of velocity basis; docs/bullet_step.md. A world without
/// ambient bodies moves bit for bit as with Base. Base: btSequentialImpulseConstraintSolver or a
/// class derived from it. Must be compiled with the same Bullet headers and precision as the
/// library.
template <class Base = btSequentialImpulseConstraintSolver>
class FluidSolver : public Base {
  static_assert(std::is_base_of_v<btSequentialImpulseConstraintSolver, Base>,
                "FluidSolver<Base>: Base must be btSequentialImpulseConstraintSolver or derived "
                "from it");
  static_assert(!std::is_base_of_v<btDeformableMultiBodyConstraintSolver, Base>,
                "FluidSolver<Base>: btDeformableMultiBodyDynamicsWorld solves rigid bodies "
                "together with deformable ones in a way that cannot be rewritten; use "
                "btSoftRigidDynamicsWorld or btMultiBodyDynamicsWorld");
  static constexpr bool kHasMultiBodies = std::is_base_of_v<btMultiBodyConstraintSolver, Base>;
  // True: Base solves all rows together, by complementarity.
  static constexpr bool kSolvesAtOnce = std::is_base_of_v<btMLCPSolver, Base> ||
                                        std::is_base_of_v<btMultiBodyMLCPConstraintSolver, Base>;
  // True: Base takes no second friction row at single contacts, because it infers the number of
  // rows from the sizes of its pools, or keeps its own pools.
  static constexpr bool kHasUniformFrictionRows =
      std::is_base_of_v<btMLCPSolver, Base> ||
      std::is_base_of_v<btSequentialImpulseConstraintSolverMt, Base>;

 public:
  /// `bodies`: bodies and trees of a fluid; makeSolver() takes them from a Fluid. Passes all
  /// further arguments to Base. Solves like Base once the fluid is destroyed.
  template <class... Args>
  explicit FluidSolver(std::shared_ptr<AmbientBodies> bodies, Args&&... args)
      : Base(std::forward<Args>(args)...),
        bodies_(std::move(bodies)),
        group_(*bodies_, pools()),
        trees_(*bodies_) {}

  /// Returns a pointer that expires when the solver is destroyed, whoever destroys it.
  std::weak_ptr<const void> life() const { return life_; }

  void prepareSolve(int body_count, int manifold_count) override {
    Base::prepareSolve(body_count, manifold_count);
    if constexpr (kHasMultiBodies) trees_.begin();
  }

  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override {
    Base::allSolved(info, debug_drawer);
    group_.goOn();
    if constexpr (kHasMultiBodies) trees_.finish(info);
  }

 protected:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count,
                                        btPersistentManifold** manifolds, int manifold_count,
                                        btTypedConstraint** constraints, int constraint_count,
                                        const btContactSolverInfo& info,
                                        btIDebugDraw* debug_drawer) override {
    bool has_multibody_rows = false;
    if constexpr (kHasMultiBodies) {
      trees_.prepare(info);
      has_multibody_rows = this->m_tmpNumMultiBodyConstraints > 0;
    }
    manifolds = group_.inOrderOfParts(manifolds, manifold_count);
    const GroupInput input{manifolds, manifold_count, constraints, constraint_count};
    converted_ = group_.select({bodies, body_count}, input, info.m_timeStep, has_multibody_rows);
    is_over_ =
        manifold_count + constraint_count == 0 && !has_multibody_rows && !hasRigidBody(converted_);
    if (is_over_) return 0;
    return Base::solveGroupCacheFriendlySetup(bodies, body_count, manifolds, manifold_count,
                                              constraints, constraint_count, info, debug_drawer);
  }

  void convertBodies(btCollisionObject** /*bodies*/, int body_count,
                     const btContactSolverInfo& info) override {
    this->m_tmpSolverBodyPool.reserve(body_count + 1);
    Base::convertBodies(converted_.first, converted_.count, info);
    group_.begin();
  }

  // Bullet calls this last in its setup: afterwards all rows exist, and are rewritten.
  void convertContacts(btPersistentManifold** manifolds, int manifold_count,
                       const btContactSolverInfo& info) override {
    group_.showExternalChange(SolverGroup::ExternalChange::kIsotropic);
    Base::convertContacts(manifolds, manifold_count, info);
    if constexpr (!kHasUniformFrictionRows) addSecondFrictions(info);
    group_.showExternalChange(SolverGroup::ExternalChange::kTrue);
    group_.rewriteRows(info);
    solved_joints_ = kSolvesAtOnce ? 0 : group_.solveJoints();
    if constexpr (kSolvesAtOnce) group_.iterateWithoutBounces([] {});
  }

  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* debug_drawer) override {
    if (is_over_) return 0;
    btContactSolverInfo once = info;
    useQuickRows();
    if constexpr (!kSolvesAtOnce)
      group_.iterateWithoutBounces([&] {
        btScalar residual = BT_LARGE_FLOAT;
        for (int i = 0; i < info.m_numIterations; ++i) {
          if (!(residual > info.m_leastSquaresResidualThreshold)) break;
          residual = solveSingleIteration(i, bodies, body_count, manifolds, manifold_count,
                                          constraints, constraint_count, info, debug_drawer);
        }
      });
    // If all rows are solved already, a threshold that any residual meets ends the iterations after
    // the first one, which removes rounding errors. A threshold that the program has set stays.
    const bool is_enough = isSolved() && !(info.m_leastSquaresResidualThreshold > 0);
    once.m_leastSquaresResidualThreshold = BT_LARGE_FLOAT;
    return Base::solveGroupCacheFriendlyIterations(bodies, body_count, manifolds, manifold_count,
                                                   constraints, constraint_count,
                                                   is_enough ? once : info, debug_drawer);
  }

  // NOLINTNEXTLINE(readability-function-size): Bullet's parameters
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info,
                                btIDebugDraw* debug_drawer) override {
    constexpr int kOtherOrders =
        SOLVER_RANDMIZE_ORDER | SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS;
    if constexpr (std::is_same_v<Base, btSequentialImpulseConstraintSolver>)
      if (hasQuickRows() && !(info.m_solverMode & kOtherOrders))
        return iterate(iteration, constraints, constraint_count, info);
    const auto iterateBase = [&] {
      return Base::solveSingleIteration(iteration, bodies, body_count, manifolds, manifold_count,
                                        constraints, constraint_count, info, debug_drawer);
    };
    if constexpr (kHasMultiBodies)
      if (hasConeFriction(info))
        return iterateWithCones(iterateBase, iteration < info.m_numIterations);
    return iterateBase();
  }

  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override {
    if (is_over_) return 0;
    if constexpr (!kHasUniformFrictionRows) reportSecondFrictions();
    group_.finish(info);
    return Base::solveGroupCacheFriendlyFinish(bodies, body_count, info);
  }

 private:
  // False: all are colliders of multibodies, whose velocities are not in the solver's bodies.
  static bool hasRigidBody(const GroupBodies& bodies) {
    return std::any_of(bodies.first, bodies.first + bodies.count,
                       [](const btCollisionObject* body) { return btRigidBody::upcast(body); });
  }

  RowPools pools() {
    RowPools pools{this->m_tmpSolverBodyPool,
                   this->m_tmpSolverContactConstraintPool,
                   this->m_tmpSolverContactFrictionConstraintPool,
                   this->m_tmpSolverContactRollingFrictionConstraintPool,
                   this->m_tmpSolverNonContactConstraintPool,
                   std::nullopt};
    if constexpr (kHasMultiBodies)
      pools.multibodies.emplace(MultiBodyRows{
          this->m_multiBodyNormalContactConstraints, this->m_multiBodyFrictionContactConstraints,
          this->m_multiBodyTorsionalFrictionContactConstraints,
          this->m_multiBodySpinningFrictionContactConstraints,
          this->m_multiBodyNonContactConstraints, this->m_data});
    return pools;
  }

  // Replaces Bullet's scalar row solvers by quick ones. Keeps row solvers with SSE of other builds
  // of Bullet, and those that the program has set.
  void useQuickRows() {
    const QuickRows& quick = quickRows();
    if (this->m_resolveSingleConstraintRowGeneric == this->getScalarConstraintRowSolverGeneric())
      this->m_resolveSingleConstraintRowGeneric = quick.generic;
    if (this->m_resolveSingleConstraintRowLowerLimit ==
        this->getScalarConstraintRowSolverLowerLimit())
      this->m_resolveSingleConstraintRowLowerLimit = quick.lower_limit;
  }

  bool hasQuickRows() const {
    return this->m_resolveSingleConstraintRowGeneric == quickRows().generic &&
           this->m_resolveSingleConstraintRowLowerLimit == quickRows().lower_limit;
  }

  // Repeats btSequentialImpulseConstraintSolver::solveSingleIteration() in its default order:
  // joints, contacts, frictions. Returns the largest squared residual [m^2/s^2].
  btScalar iterate(int iteration, btTypedConstraint** constraints, int constraint_count,
                   const btContactSolverInfo& info) {
    btAlignedObjectArray<btSolverBody>& bodies = this->m_tmpSolverBodyPool;
    btConstraintArray& joints = this->m_tmpSolverNonContactConstraintPool;
    btConstraintArray& contacts = this->m_tmpSolverContactConstraintPool;
    const auto solve = [&](const btSolverConstraint& row, btScalar largest) {
      const btScalar residual = this->resolveSingleConstraintRowGeneric(
          bodies[row.m_solverBodyIdA], bodies[row.m_solverBodyIdB], row);
      return btMax(largest, residual * residual);
    };
    const QuickRows& quick = quickRows();
    btScalar largest =
        quick.joints({joints, this->m_orderNonContactConstraintPool, bodies}, iteration, 0);
    if (iteration >= info.m_numIterations) return largest;
    solveObsolete(constraints, constraint_count, info.m_timeStep);
    largest = quick.contacts({contacts, this->m_orderTmpConstraintPool, bodies}, largest);
    largest = quick.frictions({this->m_tmpSolverContactFrictionConstraintPool,
                               this->m_orderFrictionConstraintPool, bodies},
                              contacts, largest);
    btConstraintArray& rolling = this->m_tmpSolverContactRollingFrictionConstraintPool;
    for (int i = 0; i < rolling.size(); ++i) {
      btSolverConstraint& row = rolling[i];
      const btScalar pressed = contacts[row.m_frictionIndex].m_appliedImpulse;
      if (!(pressed > 0)) continue;
      const btScalar most = row.m_friction * pressed;
      row.m_upperLimit = most > row.m_friction ? row.m_friction : most;
      row.m_lowerLimit = -row.m_upperLimit;
      largest = solve(row, largest);
    }
    return largest;
  }

  // True if two friction rows of multibodies share a limit, by which Bullet needs the C library.
  bool hasConeFriction(const btContactSolverInfo& info) const {
    return (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS) &&
           !(info.m_solverMode & SOLVER_DISABLE_IMPLICIT_CONE_FRICTION) && group_.hasMembers();
  }

  // Calls `iterate_base` without these rows, and then solves them as Bullet does. Returns the
  // largest squared residual [m^2/s^2].
  template <class Iterate>
  btScalar iterateWithCones(const Iterate& iterate_base, bool solves_contacts) {
    auto& rolling = this->m_multiBodyTorsionalFrictionContactConstraints;
    auto& sliding = this->m_multiBodyFrictionContactConstraints;
    const int rolling_count = rolling.size(), sliding_count = sliding.size();
    rolling.resizeNoInitialize(0);
    sliding.resizeNoInitialize(0);
    btScalar largest = iterate_base();
    rolling.resizeNoInitialize(rolling_count);
    sliding.resizeNoInitialize(sliding_count);
    if (!solves_contacts) return largest;
    largest = solveCones(rolling, true, largest);
    return solveCones(sliding, false, largest);
  }

  // Solves pairs of friction rows; `under_pressure`: those of contacts that are pressed together.
  // Returns the largest squared residual, or `largest`.
  template <class Rows>
  btScalar solveCones(Rows& rows, bool under_pressure, btScalar largest) {
    for (int i = 0; i + 1 < rows.size(); i += 2) {
      auto &a = rows[i], &b = rows[i + 1];
      const btScalar pressed =
          this->m_multiBodyNormalContactConstraints[a.m_frictionIndex].m_appliedImpulse;
      if (a.m_frictionIndex != b.m_frictionIndex || (under_pressure && !(pressed > 0))) continue;
      for (auto* row : {&a, &b}) {
        row->m_upperLimit = row->m_friction * pressed;
        row->m_lowerLimit = -row->m_upperLimit;
        for (auto* body : {row->m_multiBodyA, row->m_multiBodyB})
          if (body) body->setPosUpdated(false);
      }
      const btScalar residual =
          group_.touchesMember(a) ? solveFrictionPair(a, b, this->m_data, this->m_tmpSolverBodyPool)
                                  : this->resolveConeFrictionConstraintRows(a, b);
      largest = btMax(largest, residual * residual);
    }
    return largest;
  }

  // Calls solveConstraintObsolete() of all joints, by which joint classes of a program may solve
  // themselves, as Bullet does in each iteration.
  void solveObsolete(btTypedConstraint** constraints, int count, btScalar time_step) {
    for (int i = 0; i < count; ++i) {
      btTypedConstraint& constraint = *constraints[i];
      if (!constraint.isEnabled()) continue;
      const int a = this->getOrInitSolverBody(constraint.getRigidBodyA(), time_step);
      const int b = this->getOrInitSolverBody(constraint.getRigidBodyB(), time_step);
      constraint.solveConstraintObsolete(this->m_tmpSolverBodyPool[a], this->m_tmpSolverBodyPool[b],
                                         time_step);
    }
  }

  // Adds second friction rows to contacts for which SolverGroup::needsSecondFriction() is true,
  // docs/theory.md section 7. One row along the push holds the push itself. The sideways slip that
  // normal impulses cause needs a row across the first, because the iterations end before this slip
  // is zero.
  void addSecondFrictions(const btContactSolverInfo& info) {
    constexpr int kUniformModes =
        SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS;
    const btConstraintArray& contacts = this->m_tmpSolverContactConstraintPool;
    first_frictions_ = this->m_tmpSolverContactFrictionConstraintPool.size();
    if (!group_.mayNeedSecondFriction() || (info.m_solverMode & kUniformModes)) return;
    for (int i = 0; i < contacts.size(); ++i)
      if (group_.needsSecondFriction(contacts[i])) addSecondFriction(i, info);
  }

  // Adds a row across the first friction row of contact `index`, as Bullet does with
  // SOLVER_USE_2_FRICTION_DIRECTIONS.
  void addSecondFriction(int index, const btContactSolverInfo& info) {
    const btSolverConstraint& contact = this->m_tmpSolverContactConstraintPool[index];
    auto& point = *static_cast<btManifoldPoint*>(contact.m_originalContactPoint);
    const btSolverBody& a = this->m_tmpSolverBodyPool[contact.m_solverBodyIdA];
    const btSolverBody& b = this->m_tmpSolverBodyPool[contact.m_solverBodyIdB];
    const bool is_given =
        (info.m_solverMode & SOLVER_ENABLE_FRICTION_DIRECTION_CACHING) &&
        (point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED);
    btVector3& direction = point.m_lateralFrictionDir2;
    if (!is_given) {
      direction = point.m_lateralFrictionDir1.cross(point.m_normalWorldOnB).normalized();
      for (btRigidBody* body : {a.m_originalBody, b.m_originalBody})
        if (body)
          this->applyAnisotropicFriction(body, direction,
                                         btCollisionObject::CF_ANISOTROPIC_FRICTION);
    }
    this->addFrictionConstraint(
        direction, contact.m_solverBodyIdA, contact.m_solverBodyIdB, index, point,
        point.getPositionWorldOnA() - a.getWorldTransform().getOrigin(),
        point.getPositionWorldOnB() - b.getWorldTransform().getOrigin(), nullptr, nullptr,
        info.m_sor, info, is_given ? point.m_contactMotion2 : btScalar(0),
        is_given ? point.m_frictionCFM : btScalar(0));
  }

  // Writes the impulses of second friction rows into the contact points, as Bullet does with
  // SOLVER_USE_2_FRICTION_DIRECTIONS.
  void reportSecondFrictions() {
    const btConstraintArray& frictions = this->m_tmpSolverContactFrictionConstraintPool;
    for (int i = first_frictions_; i < frictions.size(); ++i) {
      const btSolverConstraint& contact =
          this->m_tmpSolverContactConstraintPool[frictions[i].m_frictionIndex];
      static_cast<btManifoldPoint*>(contact.m_originalContactPoint)->m_appliedImpulseLateral2 =
          frictions[i].m_appliedImpulse;
    }
  }

  // True if solveJoints() has solved all rows of the group.
  bool isSolved() const {
    if (solved_joints_ == 0) return false;
    if constexpr (kHasMultiBodies)
      if (this->m_multiBodyNormalContactConstraints.size() > 0 ||
          this->m_multiBodyNonContactConstraints.size() > 0)
        return false;
    return this->m_tmpSolverContactConstraintPool.size() == 0 &&
           solved_joints_ == this->m_tmpSolverNonContactConstraintPool.size();
  }

  const std::shared_ptr<AmbientBodies> bodies_;
  const std::shared_ptr<const void> life_ = std::make_shared<char>();
  SolverGroup group_;
  TreeGroup trees_;
  int first_frictions_ = 0;  // number of friction rows that Bullet has made; second ones follow
  int solved_joints_ = 0;    // number of joint rows solved before the iterations
  GroupBodies converted_;    // bodies that Bullet converts
  bool is_over_ = false;     // true: the group has no rows, and none of its bodies waits for them
};

AMBIENT_END
