#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"

class btCollisionObject;
class btPersistentManifold;
class btTypedConstraint;
struct btContactSolverInfo;

AMBIENT_BEGIN

class AmbientBodies;
class JointChains;
class JointErrors;
struct FreeBody;

/// Bodies of a group.
struct GroupBodies {
  btCollisionObject** first = nullptr;
  int count = 0;
};

/// Contacts and joints that Bullet hands to the solver for one group, before it makes rows of them.
struct GroupInput {
  btPersistentManifold** manifolds = nullptr;
  int manifold_count = 0;
  btTypedConstraint** constraints = nullptr;
  int constraint_count = 0;
};

/// Ambient bodies of the group that a solver works on, from convertBodies() to the write-back of
/// velocities. Holds the part of FluidSolver that does not depend on its base class. Reuses its
/// memory from step to step.
class SolverGroup {
 public:
  /// `pools`: of the solver; must outlive the group.
  SolverGroup(AmbientBodies& bodies, const RowPools& pools);
  ~SolverGroup();

  /// Call before Bullet makes rows. Returns the manifolds of a group: those of one pair of compound
  /// shapes in the order of the parts that touch, if one of the pair moves in a fluid. Bullet has
  /// them in the order in which they came about, which a saved state does not keep. The array lasts
  /// until the next call.
  btPersistentManifold** inOrderOfParts(btPersistentManifold** manifolds, int count) noexcept;

  /// Call before Bullet converts the bodies. Finds the ambient bodies, and returns the bodies that
  /// Bullet has to convert. Leaves out ambient bodies without contact, joint, pair in the
  /// broadphase or locked axis, because no row can move them, and flies them. `all_stay`: returns
  /// all bodies, because rows of multibodies may move any of them.
  GroupBodies select(const GroupBodies& bodies, const GroupInput& input, btScalar time_step,
                     bool all_stay) noexcept;

  /// Call after Bullet has converted the bodies. Sets the velocity changes k + X of docs/theory.md
  /// eq. (28), against which rows are solved, for bodies with contacts, joints or locked axes; sets
  /// zero for the other ambient bodies.
  void begin() noexcept;

  /// Call around Bullet's conversion of contacts. Sets the velocity change by forces and loads that
  /// Bullet reads there: kIsotropic, that of a body with isotropic inertia, k' + X, so that Bullet
  /// lays friction along the force, eq. (28b); kTrue, k + X again.
  enum class ExternalChange { kIsotropic, kTrue };
  void showExternalChange(ExternalChange change) noexcept;

  /// False: needsSecondFriction() is false for all contacts of the group.
  bool mayNeedSecondFriction() const { return may_need_second_friction_; }

  /// True if a contact needs a second friction row: its bodies are pushed along its face, by no
  /// more than friction can hold, and a push along its normal also moves one of them sideways,
  /// because of its added mass. @pre showExternalChange(kIsotropic) is in effect
  bool needsSecondFriction(const btSolverConstraint& contact) noexcept;

  /// Call after Bullet has made rows of joints and contacts. Rewrites every row that touches an
  /// ambient body, eq. (27), and applies the impulses of warm starting in the velocity bases.
  void rewriteRows(const btContactSolverInfo& info) noexcept;

  /// False: touchesMember() is false for all rows of the group.
  bool hasMembers() const noexcept;
  /// True if a row of multibodies acts on a body or tree that moves in a fluid. @pre rewriteRows()
  bool touchesMember(btMultiBodySolverConstraint& row) noexcept;

  /// Call after rewriteRows(). Solves rows of joints without loops together, eq. (27a); the
  /// iterations go on from their impulses. Returns the number of rows solved.
  int solveJoints() noexcept;

  /// If contacts bounce, calls iterate() without the bounces, which tells the velocities that these
  /// ask for, docs/theory.md eq. (28e). Call before the other iterations. @pre rewriteRows()
  template <class Iterate>
  void iterateWithoutBounces(const Iterate& iterate) noexcept {
    if (bounces_.empty()) return;
    bounces_.suspend(pools_);
    iterate();
    resumeBounces();
  }

  /// Call after the iterations, before Bullet writes velocities back. Maps velocity changes from
  /// the bases to world axes, du = T du', and flies the members that no row has
  /// moved.
  void finish(const btContactSolverInfo& info) noexcept;

  /// Call when all groups of the world are solved. If it steps together with others: makes their
  /// steps, and flies the bodies of all.
  void goOn() noexcept;

 private:
  // An ambient body that rows may move.
  struct Member {
    AmbientBody* ambient;
    bool is_locked;
    bool has_rows;
    bool is_anchored;      // true: has a joint, or a contact with a body that cannot move
    int solver_body = -1;  // index in the solver's pool
  };
  // Jacobian of a joint row before it is rewritten; Bullet computes joint feedback from it.
  struct SavedJacobian {
    int row;
    btVector3 angular_a, linear_a, angular_b, linear_b;
  };

  bool hasAmbientBody(const GroupBodies& bodies) const noexcept;
  void reserve(int bodies) noexcept;
  void findMembers(const GroupBodies& bodies, bool all_stay) noexcept;
  bool disableAll(const GroupBodies& bodies) noexcept;
  void prepareForRows(Member* const* members, int count) noexcept;
  void prepareJoinedToMultiBodies() noexcept;
  void reapplyWarmStart(int solver_mode) noexcept;
  void saveFeedbackJacobians() noexcept;
  void restoreFeedbackJacobians() noexcept;
  void resumeBounces() noexcept;
  void noteJointError(AmbientBody& ambient, const RowBody& row_body) noexcept;
  void finishBatch(RowBatch& batch, double turn_share) noexcept;
  void flyLater(const FreeBody& body) noexcept;
  void flyFreely() noexcept;
  Member* memberOf(int solver_body) noexcept;

  AmbientBodies& bodies_;
  const RowPools pools_;
  double time_step_ = 0;
  bool may_need_second_friction_ = false;
  bool is_disabled_ =
      false;          // true: the time step is not finite, and no body of the group may move
  int reserved_ = 0;  // bodies that there is room for
  std::vector<Member> members_;
  std::vector<btCollisionObject*> converted_;  // bodies that Bullet has to convert
  std::vector<int> member_of_solver_body_;     // index in members_; -1: not ambient
  std::vector<RowBatch> batches_;              // of members that rows may move
  std::size_t batch_count_ = 0;                // of batches_ in use
  std::vector<FreeBody> free_;                 // bodies to fly
  RowBodies row_bodies_;
  Bounces bounces_;
  std::unique_ptr<JointChains> joint_chains_;
  std::unique_ptr<JointErrors> joint_errors_;
  std::vector<SavedJacobian> saved_;
  std::vector<btPersistentManifold*> ordered_;  // by inOrderOfParts()
};

/// Multibodies in fluid (trees) that a solver works on. Replaces the velocities that Bullet
/// computes for dry multibodies by those in fluid. Functions are declared in the order in which
/// FluidSolver calls them in a substep. Without trees each call costs one comparison.
class TreeGroup {
 public:
  explicit TreeGroup(AmbientBodies& bodies);

  /// Call before Bullet's articulated-body pass. Stores the velocities at the start of the substep,
  /// because that pass overwrites them.
  void begin() noexcept;
  /// Call before the first group is solved; later calls in the substep do nothing. Flies trees on
  /// which only rows of their own joints act. Sets the velocity of each tree to the one that its
  /// rows are solved against, docs/theory.md section 14.
  void prepare(const btContactSolverInfo& info) noexcept;
  /// Call after all groups are solved. Sets the velocity that Bullet moves each tree by.
  void finish(const btContactSolverInfo& info) noexcept;

 private:
  /// Detaches trees whose multibody was replaced or has other links than when it was added.
  void detachReplacedTrees() noexcept;
  /// Sets TreeStep::turns_rows of trees with contacts or joints to other bodies.
  void markTurningRows() noexcept;

  AmbientBodies& bodies_;
  bool is_begun_ = false;  // true from begin() until the first group is solved
};

AMBIENT_END
