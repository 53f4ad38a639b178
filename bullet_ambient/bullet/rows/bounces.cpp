#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"

AMBIENT_BEGIN
namespace {

// Velocities along a row, of both sides, before the rows act [m/s].
struct Approach {
  bool is_in_fluid = false;
  btScalar start = 0;  // at the start of the step
  btScalar seen = 0;   // in the right-hand side of the row
  btScalar push = 0;   // change of ambient bodies by all forces
  btScalar load = 0;   // change of ambient bodies by surface loads
};

// Adds a rigid body. `is_beside_links`: the row is one of multibodies, where Bullet sees the dry
// body's forces in a time `step` [s].
void addBody(const RowSide& side, bool is_beside_links, btScalar step, const RowPools& rows,
             RowBodies& bodies, Approach& sum) {
  const btSolverBody& body = rows.solver_bodies[side.solver_body];
  const RowJacobian& jacobian = side.rigid;
  const btScalar start = jacobian.along(body.m_linearVelocity, body.m_angularVelocity);
  sum.start += start;
  sum.seen += start;
  const RowBody* const ambient = bodies.find(side.solver_body);
  if (ambient) {
    sum.is_in_fluid = true;
    sum.push += jacobian.along(ambient->velocity_change, ambient->spin_change);
    sum.load += jacobian.along(ambient->velocity_by_load, ambient->spin_by_load);
  }
  if (!is_beside_links) {
    sum.seen += jacobian.along(body.m_externalForceImpulse, body.m_externalTorqueImpulse);
    if (ambient) sum.seen += jacobian.along(ambient->velocity_excess, ambient->spin_excess);
  } else if (const btRigidBody* const dry = body.m_originalBody) {
    sum.seen += step * jacobian.along(dry->getTotalForce() * dry->getInvMass(),
                                      dry->getTotalTorque() * dry->getInvInertiaTensorWorld());
  }
}

void addLink(const RowSide& side, const btMultiBodyJacobianData& data, const AmbientTrees& trees,
             Approach& sum) {
  const btScalar* const velocity = side.multibody->getVelocityVector();
  const btScalar seen = side.along(data, [&](int i) { return velocity[i]; });
  sum.seen += seen;
  const AmbientTree* const tree = trees.findSolved(side.multibody);
  if (!tree) {
    sum.start += seen;
    return;
  }
  const TreeStep& step = tree->step;
  const Coordinates& u = step.meets_surface ? step.surface.start : step.start;
  const btScalar start = side.along(data, [&](int i) { return static_cast<btScalar>(u[i]); });
  sum.is_in_fluid = true;
  sum.start += start;
  sum.push += seen - start;
  if (!step.was_awake) return;
  const Coordinates& load = tree->flight.rowVelocityByLoads();
  sum.load += side.along(data, [&](int i) { return static_cast<btScalar>(load[i]); });
}

// Returns the velocity that Bullet's restitution asks for.
btScalar restitutionSpeed(btScalar approach, btScalar restitution, btScalar threshold) {
  return btFabs(approach) < threshold ? btScalar(0) : btMax(-restitution * approach, btScalar(0));
}

const btManifoldPoint& pointOf(const void* contact) {
  return *static_cast<const btManifoldPoint*>(contact);
}

// Returns the change of velocity along a row by the rows, of ambient bodies.
template <class Row>
btScalar speedByRows(Row& row, const RowPools& rows, const AmbientTrees& trees, RowBodies& bodies) {
  btScalar sum = 0;
  for (const RowSide& side : sidesOf(row)) {
    if (trees.findSolved(side.multibody)) {
      const btMultiBodyJacobianData& data = rows.multibodies->data;
      sum += side.along(data, [&](int i) { return data.m_deltaVelocities[side.change + i]; });
    } else if (bodies.find(side.solver_body)) {
      const btSolverBody& body = rows.solver_bodies[side.solver_body];
      sum += side.rigid.along(body.m_deltaLinearVelocity, body.m_deltaAngularVelocity);
    }
  }
  return sum;
}

}  // namespace

void Bounces::find(const RowPools& rows, const btContactSolverInfo& info, const AmbientTrees& trees,
                   RowBodies& bodies) noexcept {
  const btScalar threshold = info.m_restitutionVelocityThreshold;
  const auto findIn = [&](auto& pool) {
    for (int i = 0; i < pool.size(); ++i) {
      auto& row = pool[i];
      constexpr bool kAreMulti = kIsOfMultiBodies<std::remove_reference_t<decltype(row)>>;
      const btScalar restitution = pointOf(row.m_originalContactPoint).m_combinedRestitution;
      if (restitution == 0 || !(row.m_jacDiagABInv > 0)) continue;
      Approach sum;
      for (const RowSide& side : sidesOf(row)) {
        if (side.multibody)
          addLink(side, rows.multibodies->data, trees, sum);
        else if (side.solver_body >= 0)
          addBody(side, kAreMulti, info.m_timeStep, rows, bodies, sum);
      }
      const btScalar speed = restitutionSpeed(sum.start, restitution, threshold);
      const btScalar by_bullet =
          restitutionSpeed(kAreMulti ? sum.seen : sum.start, restitution, threshold);
      if (!sum.is_in_fluid || !(speed > 0 || by_bullet > 0)) continue;
      const btScalar asked = row.m_rhs / row.m_jacDiagABInv + sum.seen;
      bounces_.push_back(
          {kAreMulti, i, speed, asked, asked - by_bullet, sum.push, sum.load, btScalar(0)});
    }
  };
  // Grows only where Bullet's pools have grown.
  const int most =
      rows.contacts.capacity() + (rows.multibodies ? rows.multibodies->contacts.capacity() : 0);
  bounces_.reserve(static_cast<std::size_t>(most));
  findIn(rows.contacts);
  if (rows.multibodies) findIn(rows.multibodies->contacts);
}

template <class Visit>
void Bounces::visit(const RowPools& rows, const Visit& visit) noexcept {
  for (Bounce& bounce : bounces_) {
    if (bounce.is_of_multibodies)
      visit(bounce, rows.multibodies->contacts[bounce.row]);
    else
      visit(bounce, rows.contacts[bounce.row]);
  }
}

void Bounces::suspend(const RowPools& rows) noexcept {
  visit(rows, [](Bounce& bounce, auto& row) {
    bounce.right_side = row.m_rhs;
    row.m_rhs = -BT_LARGE_FLOAT;  // the impulse stays at its lower limit, 0
  });
}

void Bounces::resume(const RowPools& rows, const AmbientTrees& trees, RowBodies& bodies) noexcept {
  visit(rows, [&](const Bounce& bounce, auto& row) {
    row.m_rhs = bounce.right_side;
    if (row.m_rhs == 0) return;  // suspended: it acts along locked axes alone
    const btScalar zero = 0;
    const btScalar forces =
        bounce.push + speedByRows(row, rows, trees, bodies) - btMax(zero, bounce.load);
    const btScalar speed = btMax(zero, bounce.speed + btMin(zero, forces));
    const btScalar correction = bounce.correction;
    const btScalar wanted = correction < 0 ? speed + correction : btMax(speed, correction);
    row.m_rhs += (wanted - bounce.asked) * row.m_jacDiagABInv;
  });
}

AMBIENT_END
