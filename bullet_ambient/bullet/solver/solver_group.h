#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_pools.h"

class btCollisionObject;
class btPersistentManifold;
class btTypedConstraint;
struct btContactSolverInfo;

AMBIENT_BEGIN

struct AmbientBody;
class AmbientBodies;
class JointChains;
class JointGaps;
class RowBodies;
struct RowBody;

/// The bodies of a group.
struct GroupBodies {
  btCollisionObject** first = nullptr;
  int count = 0;
};

/// Contacts and joints that Bullet hands to the solver for one group, before their conversion.
struct GroupInput {
  btPersistentManifold** manifolds = nullptr;
  int manifold_count = 0;
  btTypedConstraint** constraints = nullptr;
  int constraint_count = 0;
};

/// The ambient bodies of the group that a solver works on, from convertBodies to the write-back.
/// Not a template: the part of FluidSolver that does not depend on its base. Reuses its memory
/// from step to step.
class SolverGroup {
 public:
  using SolverBodies = btAlignedObjectArray<btSolverBody>;

  explicit SolverGroup(AmbientBodies& bodies);
  ~SolverGroup();

  /// Before the stock conversion of the bodies: finds the ambient ones among them, and returns
  /// those that the solver has to know. What floats alone, without a contact, a joint or anything
  /// near, is not among them: no row can move it. `all_stay`: rows may come from elsewhere.
  GroupBodies select(const GroupBodies& bodies, const GroupInput& input, btScalar time_step,
                     bool all_stay) noexcept;

  /// After it: gives those with contacts or joints the velocity that their rows are solved against,
  /// docs/theory.md eq. (28).
  void begin(SolverBodies& solver_bodies) noexcept;

  /// Whether there is no ambient body.
  bool empty() const { return members_.empty(); }

  /// Around the stock conversion of contacts: shows it the push of forces and loads as an even
  /// response takes it, k' of eq. (28b), so that friction lies along the force.
  enum class Push { kEven, kTrue };
  void showPush(SolverBodies& solver_bodies, Push push) noexcept;

  /// False: no contact does what holdsSlope() asks.
  bool mayHoldSlopes() const { return may_hold_slopes_; }

  /// While it is shown: whether a contact is pushed along its face, by no more than friction can
  /// hold, and a push along its normal makes a body slip across it by its fluid.
  bool holdsSlope(const SolverBodies& solver_bodies,
                  const btSolverConstraint& contact) const noexcept;

  /// After the stock conversion of joints and contacts: rewrites every row that touches an ambient
  /// body, and applies the impulses of warm starting in the new bases. `multibodies`: null for
  /// solvers without.
  void rewriteRows(SolverBodies& solver_bodies, const RowPools& rows,
                   const MultiBodyRows* multibodies, const btContactSolverInfo& info) noexcept;

  /// After that: solves rows of joints together, from which the iterations go on. Returns how many;
  /// joint_chains.h.
  int solveJoints(SolverBodies& solver_bodies, btConstraintArray& joints) noexcept;

  /// Before the stock write-back: velocity changes back into Bullet's basis; bodies that no row has
  /// moved fly freely.
  void finish(SolverBodies& solver_bodies, btConstraintArray& joints) noexcept;

 private:
  static constexpr int kAlone = -1;  // in place of a number in the solver's pool

  struct Member {
    AmbientBody* ambient;
    bool is_locked;
    bool is_near = false;  // to another body: Bullet converts it with the pair
    bool has_rows = false;
    bool is_held = false;      // by joints, or by what cannot move
    int solver_body = kAlone;  // the solver does not know it
  };
  // The Jacobian of a joint row with feedback, as the joint made it.
  struct SavedJacobian {
    int row;
    btVector3 angular_a, linear_a, angular_b, linear_b;
  };

  void findMembers(const GroupBodies& bodies) noexcept;
  bool holdAll(const GroupBodies& bodies) noexcept;
  void markPairs(const GroupInput& input) noexcept;
  void mark(const btCollisionObject& body, bool has_rows, bool is_held) noexcept;
  GroupBodies withoutIsolatedBodies(const GroupBodies& bodies) noexcept;
  void prepareForRows(Member& member, btSolverBody& solver_body) noexcept;
  void prepareJoinedToMultiBodies(
      SolverBodies& solver_bodies,
      const btAlignedObjectArray<btMultiBodySolverConstraint>& joints) noexcept;
  void reapplyWarmStart(SolverBodies& solver_bodies, const RowPools& rows,
                        const MultiBodyRows* multibodies, int solver_mode) noexcept;
  void saveFeedbackJacobians(const btConstraintArray& joints) noexcept;
  void restoreFeedbackJacobians(btConstraintArray& joints) noexcept;
  void noteGap(AmbientBody& ambient, const RowBody& row_body) noexcept;
  void flyFreely(SolverBodies& solver_bodies) noexcept;
  void flyTogether(int first, int count, SolverBodies& solver_bodies) const noexcept;
  Member* memberOf(int solver_body) noexcept;
  const Member* memberOf(int solver_body) const noexcept;

  AmbientBodies& bodies_;
  double time_step_ = 0;
  bool may_hold_slopes_ = false;
  bool is_held_ = false;  // the group has ambient bodies, and its time step is not finite
  std::vector<Member> members_;
  std::vector<btCollisionObject*> converted_;  // those that the solver has to know
  std::vector<int> member_of_solver_body_;     // -1: not ambient
  std::vector<const Member*> free_members_;    // members that no row has moved
  std::unique_ptr<RowBodies> row_bodies_;
  std::unique_ptr<JointChains> joint_chains_;
  std::unique_ptr<JointGaps> joint_gaps_;
  std::vector<SavedJacobian> saved_;
};

AMBIENT_END
