#include "bullet_ambient/bullet/solver/bounces.h"

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include <type_traits>

#include "bullet_ambient/bullet/members/ambient_bodies.h"

AMBIENT_BEGIN
namespace {

// Jacobian of a row at a rigid body.
struct RigidSide {
  const btVector3 &linear, &angular;
  int body;
  btScalar along(const btVector3& velocity, const btVector3& spin) const {
    return linear.dot(velocity) + angular.dot(spin);
  }
};

// Jacobian of a row at a multibody, and where its velocity change begins.
struct LinkSide {
  const btMultiBody& body;
  const btScalar* jacobian;
  int change;
  template <class Coordinate>
  btScalar along(const Coordinate& at) const {
    btScalar sum = 0;
    for (int i = 0; i < body.getNumDofs() + 6; ++i) sum += jacobian[i] * at(i);
    return sum;
  }
};

// Calls rigid(RigidSide) or link(LinkSide) for each side of a row.
template <class Rigid, class Link>
void visitSides(const btSolverConstraint& row, const ContactRows&, const Rigid& rigid,
                const Link&) {
  rigid({row.m_contactNormal1, row.m_relpos1CrossNormal, row.m_solverBodyIdA});
  rigid({row.m_contactNormal2, row.m_relpos2CrossNormal, row.m_solverBodyIdB});
}
template <class Rigid, class Link>
void visitSides(const btMultiBodySolverConstraint& row, const ContactRows& rows, const Rigid& rigid,
                const Link& link) {
  const auto& jacobians = rows.multibodies->data.m_jacobians;
  if (row.m_multiBodyA)
    link({*row.m_multiBodyA, &jacobians[row.m_jacAindex], row.m_deltaVelAindex});
  else if (row.m_solverBodyIdA >= 0)
    rigid({row.m_contactNormal1, row.m_relpos1CrossNormal, row.m_solverBodyIdA});
  if (row.m_multiBodyB)
    link({*row.m_multiBodyB, &jacobians[row.m_jacBindex], row.m_deltaVelBindex});
  else if (row.m_solverBodyIdB >= 0)
    rigid({row.m_contactNormal2, row.m_relpos2CrossNormal, row.m_solverBodyIdB});
}

// Returns the tree that the solver moves in a fluid; null: none.
const AmbientTree* treeOf(const ContactRows& rows, const btMultiBody& body) {
  const AmbientTrees* const trees = rows.multibodies->trees;
  const AmbientTree* const tree = trees ? trees->find(&body) : nullptr;
  return tree && isSolved(*tree) ? tree : nullptr;
}

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
void add(const RigidSide& side, bool is_beside_links, btScalar step, const ContactRows& rows,
         Approach& sum) {
  const btSolverBody& body = rows.solver_bodies[side.body];
  const btScalar start = side.along(body.m_linearVelocity, body.m_angularVelocity);
  sum.start += start;
  sum.seen += start;
  const RowBody* const ambient = rows.bodies.find(side.body);
  if (ambient) {
    sum.is_in_fluid = true;
    sum.push += side.along(ambient->velocity_change, ambient->spin_change);
    sum.load += side.along(ambient->velocity_by_load, ambient->spin_by_load);
  }
  if (!is_beside_links) {
    sum.seen += side.along(body.m_externalForceImpulse, body.m_externalTorqueImpulse);
    if (ambient) sum.seen += side.along(ambient->velocity_excess, ambient->spin_excess);
  } else if (const btRigidBody* const dry = body.m_originalBody) {
    sum.seen += step * side.along(dry->getTotalForce() * dry->getInvMass(),
                                  dry->getTotalTorque() * dry->getInvInertiaTensorWorld());
  }
}

void add(const LinkSide& side, const ContactRows& rows, Approach& sum) {
  const btScalar* const velocity = side.body.getVelocityVector();
  const btScalar seen = side.along([&](int i) { return velocity[i]; });
  sum.seen += seen;
  const AmbientTree* const tree = treeOf(rows, side.body);
  if (!tree) {
    sum.start += seen;
    return;
  }
  const TreeStep& step = tree->step;
  const Coordinates& u = step.meets_surface ? step.surface.start : step.start;
  const btScalar start = side.along([&](int i) { return static_cast<btScalar>(u[i]); });
  sum.is_in_fluid = true;
  sum.start += start;
  sum.push += seen - start;
  if (!step.was_awake) return;
  const Coordinates& load = tree->flight.rowVelocityByLoads();
  sum.load += side.along([&](int i) { return static_cast<btScalar>(load[i]); });
}

// True for rows of multibodies.
template <class Row>
constexpr bool kIsOfLinks = std::is_same_v<Row, btMultiBodySolverConstraint>;

template <class Row>
Approach approachOf(const Row& row, const ContactRows& rows, btScalar step) {
  Approach sum;
  visitSides(
      row, rows, [&](const RigidSide& side) { add(side, kIsOfLinks<Row>, step, rows, sum); },
      [&](const LinkSide& side) { add(side, rows, sum); });
  return sum;
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
btScalar speedByRows(const Row& row, const ContactRows& rows) {
  btScalar sum = 0;
  visitSides(
      row, rows,
      [&](const RigidSide& side) {
        if (!rows.bodies.find(side.body)) return;
        const btSolverBody& body = rows.solver_bodies[side.body];
        sum += side.along(body.m_deltaLinearVelocity, body.m_deltaAngularVelocity);
      },
      [&](const LinkSide& side) {
        if (!treeOf(rows, side.body)) return;
        const auto& changes = rows.multibodies->data.m_deltaVelocities;
        sum += side.along([&](int i) { return changes[side.change + i]; });
      });
  return sum;
}

}  // namespace

template <class Row>
void Bounces::findIn(const btAlignedObjectArray<Row>& pool, const ContactRows& rows,
                     const btContactSolverInfo& info) noexcept {
  for (int i = 0; i < pool.size(); ++i) {
    const Row& row = pool[i];
    const btScalar restitution = pointOf(row.m_originalContactPoint).m_combinedRestitution;
    if (restitution == 0 || !(row.m_jacDiagABInv > 0)) continue;
    const Approach sum = approachOf(row, rows, info.m_timeStep);
    const btScalar threshold = info.m_restitutionVelocityThreshold;
    const btScalar speed = restitutionSpeed(sum.start, restitution, threshold);
    const btScalar by_bullet =
        restitutionSpeed(kIsOfLinks<Row> ? sum.seen : sum.start, restitution, threshold);
    if (!sum.is_in_fluid || !(speed > 0 || by_bullet > 0)) continue;
    const btScalar asked = row.m_rhs / row.m_jacDiagABInv + sum.seen;
    bounces_.push_back(
        {kIsOfLinks<Row>, i, speed, asked, asked - by_bullet, sum.push, sum.load, btScalar(0)});
  }
}

template <class Visit>
void Bounces::visit(const ContactRows& rows, const Visit& visit) noexcept {
  for (Bounce& bounce : bounces_) {
    if (bounce.is_of_links)
      visit(bounce, rows.multibodies->contacts[bounce.row]);
    else
      visit(bounce, rows.contacts[bounce.row]);
  }
}

void Bounces::find(const ContactRows& rows, const btContactSolverInfo& info) noexcept {
  // Grows only where Bullet's pools have grown.
  const int most =
      rows.contacts.capacity() + (rows.multibodies ? rows.multibodies->contacts.capacity() : 0);
  bounces_.reserve(static_cast<std::size_t>(most));
  findIn(rows.contacts, rows, info);
  if (rows.multibodies) findIn(rows.multibodies->contacts, rows, info);
}

void Bounces::suspend(const ContactRows& rows) noexcept {
  visit(rows, [](Bounce& bounce, auto& row) {
    bounce.right_side = row.m_rhs;
    row.m_rhs = -BT_LARGE_FLOAT;  // the impulse stays at its lower limit, 0
  });
}

void Bounces::resume(const ContactRows& rows) noexcept {
  visit(rows, [&](const Bounce& bounce, auto& row) {
    row.m_rhs = bounce.right_side;
    if (row.m_rhs == 0) return;  // suspended: it acts along locked axes alone
    const btScalar zero = 0;
    const btScalar forces = bounce.push + speedByRows(row, rows) - btMax(zero, bounce.load);
    const btScalar speed = btMax(zero, bounce.speed + btMin(zero, forces));
    const btScalar correction = bounce.correction;
    const btScalar wanted = correction < 0 ? speed + correction : btMax(speed, correction);
    row.m_rhs += (wanted - bounce.asked) * row.m_jacDiagABInv;
  });
}

AMBIENT_END
