#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ambient::test {

ContactPair::ContactPair(Arbitrary& arbitrary, CoupledBody a, CoupledBody b)
    : a_(std::move(a)), b_(std::move(b)), manifold_(&a_.body(), &b_.body(), 0, 1, 1) {
  const Vector3 from_a = arbitrary.vector(a_.size() / 2);
  const btVector3 at = a_.body().getWorldTransform().getOrigin() + toBt(from_a);
  if (!b_.isFixed()) {
    btTransform pose = b_.body().getWorldTransform();
    pose.setOrigin(at + toBt(arbitrary.vector(b_.size() / 2)));
    b_.body().setWorldTransform(pose);
  }
  addPointAt(at, toBt(arbitrary.vector()).normalized());
}

void ContactPair::addPoint(Arbitrary& arbitrary) {
  const btVector3 at =
      a_.body().getWorldTransform().getOrigin() + toBt(arbitrary.vector(a_.size() / 2));
  addPointAt(at, toBt(arbitrary.vector()).normalized());
}

void ContactPair::addPointAt(const btVector3& at, const btVector3& normal) {
  btManifoldPoint point(a_.body().getWorldTransform().inverse() * at,
                        b_.body().getWorldTransform().inverse() * at, normal, 0);
  point.m_positionWorldOnA = at;
  point.m_positionWorldOnB = at;
  // Fixes the friction directions, so that the reference can use them.
  point.m_contactPointFlags = BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
  btPlaneSpace1(normal, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2);
  manifold_.addManifoldPoint(point);
}

Vector3r ContactPair::normal(int at) const {
  return exact(manifold_.getContactPoint(at).m_normalWorldOnB);
}

Vector3r ContactPair::tangent(int i, int at) const {
  const btManifoldPoint& point = manifold_.getContactPoint(at);
  return exact(i == 0 ? point.m_lateralFrictionDir1 : point.m_lateralFrictionDir2);
}

Vector3r ContactPair::fromA(int at) const {
  return exact(manifold_.getContactPoint(at).m_positionWorldOnA) -
         exact(a_.body().getWorldTransform().getOrigin());
}

Vector3r ContactPair::fromB(int at) const {
  return exact(manifold_.getContactPoint(at).m_positionWorldOnB) -
         exact(b_.body().getWorldTransform().getOrigin());
}

reference::DenseRow ContactPair::row(const Vector3r& direction, int at) const {
  return reference::pointRow(direction, fromA(at), fromB(at));
}

Real ContactPair::approach(const Vector3r& direction, const DenseVector6& u_a,
                           const DenseVector6& u_b, int at) const {
  const reference::DenseRow r = row(direction, at);
  return r.jacobian_a.dot(u_a) + r.jacobian_b.dot(u_b);
}

void ContactPair::makeApproaching() {
  if (approach(normal(), a_.velocity(), b_.velocity()) < 0) return;
  for (const CoupledBody* body : {&a_, &b_}) {
    body->body().setLinearVelocity(-body->body().getLinearVelocity());
    body->body().setAngularVelocity(-body->body().getAngularVelocity());
  }
}

void ContactPair::setVelocities(const DenseVector6& u_a, const DenseVector6& u_b) {
  a_.setVelocity(u_a);
  b_.setVelocity(u_b);
}

std::vector<reference::DenseRow> ContactPair::frictionRows(Real normal_velocity,
                                                           FrictionBound bound, Real dt) {
  std::vector<reference::DenseRow> rows = {row(normal())};
  rows[0].target = normal_velocity;
  rows[0].lower = 0;
  Real limit = point().m_combinedFriction;
  if (bound == FrictionBound::kFrictionlessNormalImpulse)
    limit *= reference::solveDense(dense(dt), rows).impulses[0];
  for (int i : {0, 1}) {
    reference::DenseRow friction = row(tangent(i));
    friction.friction = point().m_combinedFriction;
    friction.normal_row = bound == FrictionBound::kNormalImpulse ? 0 : -1;
    friction.lower = -limit;
    friction.upper = limit;
    rows.push_back(friction);
  }
  return rows;
}

btContactSolverInfo plainSettings(double dt) {
  btContactSolverInfo info;
  info.m_timeStep = btScalar(dt);
  info.m_solverMode = SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  info.m_splitImpulse = 0;
  info.m_erp = info.m_erp2 = 0;
  info.m_restitutionVelocityThreshold = 0;
  return info;
}

double arbitraryRatio(Arbitrary& arbitrary) { return std::pow(10, arbitrary.between(-3, 4)); }

ContactPair arbitraryPair(Arbitrary& arbitrary, Other other) {
  CoupledBody a = CoupledBody::random(arbitrary, arbitraryRatio(arbitrary));
  const double ratio_b = other == Other::kAmbient ? arbitraryRatio(arbitrary) : 0;
  CoupledBody b =
      other == Other::kPlane ? CoupledBody::fixed() : CoupledBody::random(arbitrary, ratio_b);
  ContactPair pair(arbitrary, std::move(a), std::move(b));
  pair.makeApproaching();
  return pair;
}

double gyroscopicTime(const ContactPair& pair, double part) {
  const double dt = pair.a().gyroscopicTime(part);
  return pair.b().isFixed() ? dt : std::min(dt, pair.b().gyroscopicTime(part));
}

void pushAtRandom(Arbitrary& arbitrary, const ContactPair& pair, double dt) {
  for (const CoupledBody* body : {&pair.a(), &pair.b()}) {
    if (body->isFixed()) continue;
    const double push = 0.05 / (dt * static_cast<double>(body->body().getInvMass()));
    body->body().applyCentralForce(toBt(arbitrary.vector(push)));
    if (body->isAmbient()) body->body().applyTorque(toBt(arbitrary.vector(push * body->size())));
  }
}

double worstError(const ContactPair& pair, const reference::DenseSolution& expected,
                  const Before& before) {
  const double a = pair.a().error(expected.velocities[0], before.a);
  return pair.b().isFixed() ? a : std::max(a, pair.b().error(expected.velocities[1], before.b));
}

btContactSolverInfo convergingSettings(double dt) {
  btContactSolverInfo info = plainSettings(dt);
  info.m_numIterations = 4000;
  info.m_leastSquaresResidualThreshold = SIMD_EPSILON * SIMD_EPSILON;
  return info;
}

bool touch(const reference::DenseSolution& solution) {
  return solution.impulses.cwiseAbs().maxCoeff() > 1e-9L;
}

}  // namespace ambient::test
