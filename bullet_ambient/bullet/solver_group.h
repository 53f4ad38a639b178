#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "bullet_ambient/bullet/ambient_registry.h"
#include "bullet_ambient/bullet/multibody_rows.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/row_rewriting.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The rows that Bullet has set up for one group of bodies.
struct RowPools {
  btConstraintArray& contacts;
  btConstraintArray& frictions;
  btConstraintArray& torsional_frictions;
  btConstraintArray& joints;
};

/// What Bullet hands to the solver for one group, before anything is converted.
struct GroupInput {
  btPersistentManifold** manifolds = nullptr;
  int manifold_count = 0;
  btTypedConstraint** constraints = nullptr;
  int constraint_count = 0;
};

/// The ambient bodies of the group that a solver works on, from convertBodies to the write-back.
/// Not a template: the part of AmbientSolver that does not depend on its base. Reuses its memory
/// from step to step.
class SolverGroup {
 public:
  using SolverBodies = btAlignedObjectArray<btSolverBody>;

  /// After the stock conversion of the bodies: finds the ambient ones among them, and gives those
  /// with contacts or joints the velocity that their rows are solved against, docs/theory.md eq.
  /// (28).
  void begin(AmbientRegistry& registry, SolverBodies& solver_bodies, const GroupInput& input,
             btScalar time_step) noexcept;

  /// After the stock conversion of joints and contacts: rewrites every row that touches an ambient
  /// body, and applies the impulses of warm starting in the new bases. `multibodies`: null for
  /// solvers without.
  void rewriteRows(SolverBodies& solver_bodies, const RowPools& rows,
                   const MultiBodyRows* multibodies, const btContactSolverInfo& info) noexcept;

  /// Before the stock write-back: velocity changes back into Bullet's basis; bodies that no row has
  /// moved fly freely.
  void finish(SolverBodies& solver_bodies, btConstraintArray& joints) noexcept;

 private:
  struct Member {
    AmbientBody* ambient;
    int solver_body;
    bool has_rows;
    bool is_locked;
  };
  // The Jacobian of a joint row with feedback, as the joint made it.
  struct SavedJacobian {
    int row;
    btVector3 angular_a, linear_a, angular_b, linear_b;
  };

  void findMembers(AmbientRegistry& registry, SolverBodies& solver_bodies) noexcept;
  void markBodiesWithRows(const SolverBodies& solver_bodies, const GroupInput& input) noexcept;
  void mark(const SolverBodies& solver_bodies, const btCollisionObject& body) noexcept;
  void prepareForRows(Member& member, btSolverBody& solver_body) noexcept;
  void prepareJoinedToMultiBodies(SolverBodies& solver_bodies,
                                  const btMultiBodyConstraintArray& joints) noexcept;
  void reapplyWarmStart(SolverBodies& solver_bodies, const RowPools& rows,
                        const MultiBodyRows* multibodies, int solver_mode) noexcept;
  void saveFeedbackJacobians(const btConstraintArray& joints) noexcept;
  void restoreFeedbackJacobians(btConstraintArray& joints) noexcept;
  void flyFreely(SolverBodies& solver_bodies) noexcept;
  void flyTogether(int first, int count, SolverBodies& solver_bodies) const noexcept;
  Member* memberOf(int solver_body) noexcept;

  AmbientRegistry* registry_ = nullptr;
  double time_step_ = 0;
  std::vector<Member> members_;
  std::vector<int> member_of_solver_body_;  // -1: not ambient
  std::vector<const Member*> fliers_;       // members that no row has moved
  RowBodies row_bodies_;
  std::vector<SavedJacobian> saved_;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
