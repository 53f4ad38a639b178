// Selects the bodies of a group that Bullet has to convert to solver bodies.
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cmath>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/rows/joint_chains.h"
#include "bullet_ambient/bullet/rows/joint_gaps.h"
#include "bullet_ambient/bullet/rows/row_motion.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"
#include "bullet_ambient/bullet/solver/solver_group.h"
#include "bullet_ambient/immersed/fluid_reading.h"
#include "bullet_ambient/motion/rows/axis_locks.h"

AMBIENT_BEGIN
namespace {

// Tells what may move a body in this substep. Written into its companion id while bodies are
// selected: Bullet overwrites the id when it converts the body.
struct Marks {
  bool is_near = false;   // has a joint, or a pair with another body in the broadphase
  bool has_rows = false;  // has a joint or contact
  bool is_held = false;   // has a joint, or a contact with a body that cannot move
};

// Companion ids. Bullet's own are from -2 on: -1, not converted; -2, cannot move.
constexpr int kNear = -3, kRows = -4, kHeld = -5;

Marks marksOf(const btCollisionObject& body) {
  const int id = body.getCompanionId();
  return {id <= kNear && id >= kHeld, id <= kRows && id >= kHeld, id == kHeld};
}

// Leaves bodies that cannot move alone: solvers of other groups may read them at the same time.
void mark(const btCollisionObject& body, int id) {
  if (body.isStaticOrKinematicObject() || !btRigidBody::upcast(&body)) return;
  const bool is_marked = marksOf(body).is_near;
  const int known = body.getCompanionId();
  // Bullet writes to bodies of manifolds, too.
  const_cast<btCollisionObject&>(body).setCompanionId(is_marked && known < id ? known : id);
}

// Marks the bodies in contact manifolds and joints.
void markPairs(const GroupInput& input) {
  for (int i = 0; i < input.manifold_count; ++i) {
    const btPersistentManifold& manifold = *input.manifolds[i];
    const bool has_rows = manifold.getNumContacts() > 0;
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    const auto idBeside = [has_rows](const btCollisionObject& other) {
      if (!has_rows) return kNear;
      return other.isStaticOrKinematicObject() ? kHeld : kRows;
    };
    mark(a, idBeside(b));
    mark(b, idBeside(a));
  }
  for (int i = 0; i < input.constraint_count; ++i) {
    const btTypedConstraint& constraint = *input.constraints[i];
    if (!constraint.isEnabled()) continue;
    mark(constraint.getRigidBodyA(), kHeld);
    mark(constraint.getRigidBodyB(), kHeld);
  }
}

}  // namespace

GroupBodies SolverGroup::select(const GroupBodies& bodies, const GroupInput& input,
                                btScalar time_step, bool all_stay) noexcept {
  time_step_ = static_cast<double>(time_step);
  members_.clear();
  saved_.clear();
  batch_count_ = 0;
  is_held_ = false;
  if (bodies_.size() == 0) return bodies;
  bodies_.solved.fetch_add(1, std::memory_order_relaxed);
  if (!std::isfinite(time_step_)) {
    is_held_ = holdAll(bodies);
    return bodies;
  }
  if (!hasAmbientBody(bodies)) return bodies;
  reserve(bodies.count);
  markPairs(input);
  findMembers(bodies, all_stay);
  return {converted_.data(), static_cast<int>(converted_.size())};
}

bool SolverGroup::hasAmbientBody(const GroupBodies& bodies) const noexcept {
  for (int i = 0; i < bodies.count; ++i)
    if (bodies_.find(bodies.first[i])) return true;
  return false;
}

// Reserves for all bodies of the group: the number of converted ones changes from step to step, and
// later steps must not allocate.
void SolverGroup::reserve(int bodies) noexcept {
  const auto count = static_cast<std::size_t>(bodies);
  members_.reserve(count);
  // Some solvers of Bullet convert one body more, which cannot move.
  converted_.reserve(count);
  member_of_solver_body_.reserve(count + 1);
  free_.reserve(bodies_.task_runner ? count : kFlightsTogether);
  // One batch of bodies joined to multibodies may be begun besides.
  const std::size_t batches = count / kFlightsTogether + 2;
  if (batches_.size() < batches) batches_.resize(batches);
  row_bodies_->reserve(bodies + 1);
  joint_chains_->reserve(bodies);
}

// Fills members_ and converted_. Flies the ambient bodies that no row can move.
void SolverGroup::findMembers(const GroupBodies& bodies, bool all_stay) noexcept {
  converted_.clear();
  for (int i = 0; i < bodies.count; ++i) {
    btCollisionObject& object = *bodies.first[i];
    AmbientBody* ambient = bodies_.find(&object);
    if (!ambient || !prepareStep(*ambient, bodies_, time_step_)) {
      converted_.push_back(&object);
      continue;
    }
    stopIfNotFinite(*ambient, bodies_.complaints);
    const Marks marks = marksOf(object);
    const bool is_locked = !axisFactors(*ambient->body).areFree();
    if (ambient->reading)
      beginBodyReading(*ambient, readState(*ambient->body), readSurroundings(*ambient), is_locked);
    if (all_stay || is_locked || marks.is_near) {
      converted_.push_back(&object);
      members_.push_back({ambient, &object, is_locked, marks.has_rows, marks.is_held});
    } else {
      object.setCompanionId(kAlone);
      flyLater({ambient, kAlone}, nullptr);
    }
  }
  flyFreely(nullptr);
}

// Disables the ambient bodies, so that Bullet does not move them. Returns true if there are any.
bool SolverGroup::holdAll(const GroupBodies& bodies) noexcept {
  bool is_any = false;
  for (int i = 0; i < bodies.count; ++i) {
    AmbientBody* ambient = bodies_.find(bodies.first[i]);
    if (!ambient || !ambient->isInFluid() || ambient->body->isStaticOrKinematicObject()) continue;
    is_any = true;
    hold(*ambient, bodies_);
  }
  return is_any;
}

// Counts the steps in a row in which a joint of the body misses by more than kWideGap of its size.
// Reports the body after kLongGape steps.
void SolverGroup::noteGap(AmbientBody& ambient, const RowBody& row_body) noexcept {
  const double size = ambient.metric().reference_length;
  const bool is_wide = size > 0 && row_body.gap > kWideGap * size;
  ambient.gaping = is_wide ? ambient.gaping + 1 : 0;
  if (ambient.gaping != kLongGape) return;
  const Member* other = memberOf(row_body.gap_to);
  bodies_.complaints.sayGaping(*ambient.def, other ? other->ambient->def.get() : nullptr);
}

AMBIENT_END
