// Selects the bodies of a group that Bullet has to convert to solver bodies.
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cmath>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/reading/body_reading.h"
#include "bullet_ambient/bullet/rows/joint_chains.h"
#include "bullet_ambient/bullet/rows/joint_gaps.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"
#include "bullet_ambient/bullet/solver/solver_group.h"
#include "bullet_ambient/motion/flight/axis_locks.h"

AMBIENT_BEGIN

GroupBodies SolverGroup::select(const GroupBodies& bodies, const GroupInput& input,
                                btScalar time_step, bool all_stay) noexcept {
  time_step_ = static_cast<double>(time_step);
  members_.clear();
  saved_.clear();
  is_held_ = false;
  if (bodies_.size() == 0) return bodies;
  bodies_.solved.fetch_add(1, std::memory_order_relaxed);
  if (!std::isfinite(time_step_)) {
    is_held_ = holdAll(bodies);
    return bodies;
  }
  findMembers(bodies);
  if (members_.empty()) return bodies;
  // Reserves for all bodies of the group: the number of converted ones changes from step to step,
  // and later steps must not allocate.
  converted_.reserve(static_cast<std::size_t>(bodies.count));
  member_of_solver_body_.reserve(static_cast<std::size_t>(bodies.count));
  moved_members_.reserve(static_cast<std::size_t>(bodies.count));
  row_bodies_->reserve(bodies.count);
  joint_chains_->reserve(bodies.count);
  markPairs(input);
  return all_stay ? bodies : withoutIsolatedBodies(bodies);
}

// Fills members_. Stores the index of each member in the companion id of its body, which Bullet
// overwrites when it converts the body.
void SolverGroup::findMembers(const GroupBodies& bodies) noexcept {
  for (int i = 0; i < bodies.count; ++i) {
    btCollisionObject& object = *bodies.first[i];
    AmbientBody* ambient = bodies_.find(&object);
    if (!ambient || !prepareStep(*ambient, bodies_, time_step_)) continue;
    stopIfNotFinite(*ambient, bodies_.complaints);
    object.setCompanionId(static_cast<int>(members_.size()));
    const bool is_locked = !axisFactors(*ambient->body).areFree();
    if (ambient->reading) beginBodyReading(*ambient, is_locked);
    members_.push_back({ambient, &object, is_locked});
  }
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

// Marks the members in contact manifolds and joints.
void SolverGroup::markPairs(const GroupInput& input) noexcept {
  for (int i = 0; i < input.manifold_count; ++i) {
    const btPersistentManifold& manifold = *input.manifolds[i];
    const bool has_rows = manifold.getNumContacts() > 0;
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    mark(a, has_rows, has_rows && b.isStaticOrKinematicObject());
    mark(b, has_rows, has_rows && a.isStaticOrKinematicObject());
  }
  for (int i = 0; i < input.constraint_count; ++i) {
    const btTypedConstraint& constraint = *input.constraints[i];
    if (!constraint.isEnabled()) continue;
    mark(constraint.getRigidBodyA(), true, true);
    mark(constraint.getRigidBodyB(), true, true);
  }
}

void SolverGroup::mark(const btCollisionObject& body, bool has_rows, bool is_held) noexcept {
  const int id = body.getCompanionId();
  if (id < 0 || static_cast<std::size_t>(id) >= members_.size()) return;
  Member& member = members_[id];
  if (member.object != &body) return;  // a companion id of another group
  member.is_near = true;
  member.has_rows = member.has_rows || has_rows;
  member.is_held = member.is_held || is_held;
}

// Returns the bodies of a group without members that no row can move; sets their companion ids to
// kAlone. @pre members_ are in the order of `bodies`
GroupBodies SolverGroup::withoutIsolatedBodies(const GroupBodies& bodies) noexcept {
  converted_.clear();
  std::size_t next = 0;
  for (int i = 0; i < bodies.count; ++i) {
    btCollisionObject* object = bodies.first[i];
    const bool is_member = next < members_.size() && members_[next].object == object;
    const Member* member = is_member ? &members_[next++] : nullptr;
    if (!member || member->is_near || member->is_locked) {
      converted_.push_back(object);
    } else {
      object->setCompanionId(kAlone);
    }
  }
  return {converted_.data(), static_cast<int>(converted_.size())};
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
