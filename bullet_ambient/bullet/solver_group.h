#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include <memory>

#include "bullet_ambient/bullet/precision_check.h"

class btPersistentManifold;
class btTypedConstraint;
struct btContactSolverInfo;
struct btMultiBodyJacobianData;
struct btMultiBodySolverConstraint;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

class AmbientRegistry;
class GroupMembers;

/// The rows that Bullet has set up for one group of bodies.
struct RowPools {
  btConstraintArray& contacts;
  btConstraintArray& frictions;
  btConstraintArray& torsional_frictions;
  btConstraintArray& joints;
};

/// The rows between multibodies and what they touch or are joined to.
struct MultiBodyRows {
  btAlignedObjectArray<btMultiBodySolverConstraint>& contacts;
  btAlignedObjectArray<btMultiBodySolverConstraint>& frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& rolling_frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& spinning_frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& joints;
  const btMultiBodyJacobianData& data;  ///< Jacobians of the multibodies and their responses
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

  explicit SolverGroup(AmbientRegistry& registry);
  ~SolverGroup();

  /// After the stock conversion of the bodies: finds the ambient ones among them, and gives those
  /// with contacts or joints the velocity that their rows are solved against, docs/theory.md eq.
  /// (28).
  void begin(SolverBodies& solver_bodies, const GroupInput& input, btScalar time_step) noexcept;

  /// After the stock conversion of joints and contacts: rewrites every row that touches an ambient
  /// body, and applies the impulses of warm starting in the new bases. `multibodies`: null for
  /// solvers without.
  void rewriteRows(SolverBodies& solver_bodies, const RowPools& rows,
                   const MultiBodyRows* multibodies, const btContactSolverInfo& info) noexcept;

  /// Before the stock write-back: velocity changes back into Bullet's basis; bodies that no row has
  /// moved fly freely.
  void finish(SolverBodies& solver_bodies, btConstraintArray& joints) noexcept;

 private:
  std::unique_ptr<GroupMembers> members_;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
