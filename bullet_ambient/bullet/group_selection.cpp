// Which bodies of a group Bullet's solver has to know: the part of SolverGroup before they are
// converted.
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cmath>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/flight_coupling.h"
#include "bullet_ambient/bullet/joint_chains.h"
#include "bullet_ambient/bullet/row_rewriting.h"
#include "bullet_ambient/bullet/solver_group.h"
#include "bullet_ambient/motion/axis_locks.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

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
  // For all of them: how many the solver knows changes from step to step.
  converted_.reserve(static_cast<std::size_t>(bodies.count));
  member_of_solver_body_.reserve(static_cast<std::size_t>(bodies.count));
  row_bodies_->reserve(bodies.count);
  joint_chains_->reserve(bodies.count);
  markPairs(input);
  return all_stay ? bodies : withoutLoners(bodies);
}

// Bullet's companion number, which it sets when it converts a body, tells the member until then.
void SolverGroup::findMembers(const GroupBodies& bodies) noexcept {
  for (int i = 0; i < bodies.count; ++i) {
    btCollisionObject& object = *bodies.first[i];
    AmbientBody* ambient = bodies_.find(&object);
    if (!ambient || !prepareStep(*ambient, bodies_, time_step_)) continue;
    stopIfNotFinite(*ambient, bodies_.complaints);
    object.setCompanionId(static_cast<int>(members_.size()));
    members_.push_back({ambient, !axisFactors(*ambient->body).areFree()});
  }
}

// Bullet moves no body that is disabled. Whether there are any.
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
  if (member.ambient->body != &body) return;  // a number of another group
  member.is_near = true;
  member.has_rows = member.has_rows || has_rows;
  member.is_held = member.is_held || is_held;
}

GroupBodies SolverGroup::withoutLoners(const GroupBodies& bodies) noexcept {
  converted_.clear();
  std::size_t next = 0;
  for (int i = 0; i < bodies.count; ++i) {
    btCollisionObject* object = bodies.first[i];
    const bool is_member = next < members_.size() && members_[next].ambient->body == object;
    const Member* member = is_member ? &members_[next++] : nullptr;
    if (!member || member->is_near || member->is_locked) {
      converted_.push_back(object);
    } else {
      object->setCompanionId(kAlone);
    }
  }
  return {converted_.data(), static_cast<int>(converted_.size())};
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
