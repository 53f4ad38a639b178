#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient::test {
namespace {

btTransform arbitraryPose(Arbitrary& arbitrary) {
  const Quaternion q(arbitrary.rotation());
  btTransform pose;
  pose.setRotation(
      btQuaternion(btScalar(q.x()), btScalar(q.y()), btScalar(q.z()), btScalar(q.w())));
  pose.setOrigin(toBt(arbitrary.vector()));
  return pose;
}

// Coupled added mass with the largest eigenvalue `largest` in units of mass and size.
Matrix6 arbitraryAddedMass(Arbitrary& arbitrary, double largest, double size) {
  const Matrix6 shape = arbitrary.positiveDefinite();
  const double top = symmetricEigen<6>(shape).values[5];
  Vector6 units = Vector6::Ones();
  units.head<3>().setConstant(size);
  return largest / top * (units.asDiagonal() * shape * units.asDiagonal());
}

}  // namespace

Matrix3r exact(const btMatrix3x3& m) {
  Matrix3r result;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) result(row, column) = m[row][column];
  return result;
}

CoupledBody CoupledBody::random(Arbitrary& arbitrary, double fluid_ratio) {
  CoupledBody result;
  const double mass = std::pow(10, arbitrary.between(-1, 1));
  result.size_ = std::pow(10, arbitrary.between(-1, 0));
  const Vector3 moments =
      mass * result.size_ * result.size_ *
      Vector3{arbitrary.between(0.3, 1), arbitrary.between(0.3, 1), arbitrary.between(0.3, 1)};
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, nullptr, toBt(moments));
  info.m_startWorldTransform = arbitraryPose(arbitrary);
  result.body_ = std::make_unique<btRigidBody>(info);
  result.body_->setFlags(0);  // removes Bullet's gyroscopic torque, absent in the reference
  result.body_->setLinearVelocity(toBt(arbitrary.vector()));
  result.body_->setAngularVelocity(toBt(arbitrary.vector(1 / result.size_)));
  if (fluid_ratio > 0) {
    result.fluid_ = arbitraryAddedMass(arbitrary, fluid_ratio * mass, result.size_);
  }
  return result;
}

CoupledBody CoupledBody::fixed() {
  CoupledBody result;
  result.fixed_ = true;
  result.body_ = std::make_unique<btRigidBody>(0, nullptr, nullptr);
  return result;
}

void CoupledBody::attachTo(AmbientBodies& members) const {
  if (!isAmbient()) return;
  auto fluid_body = std::make_shared<FluidBody>();
  fluid_body->name = "coupled";
  fluid_body->added_mass = fluid_;
  AttachDef def{fluid_body};
  def.medium.density = 1;
  attachBody(members, *body_, def);
}

DenseVector6 CoupledBody::velocity() const {
  DenseVector6 u;
  u << exact(body_->getAngularVelocity()), exact(body_->getLinearVelocity());
  return u;
}

void CoupledBody::setVelocity(const DenseVector6& velocity) const {
  body_->setAngularVelocity(toBt(velocity.head<3>().cast<double>()));
  body_->setLinearVelocity(toBt(velocity.tail<3>().cast<double>()));
}

DenseMatrix6 CoupledBody::inertia() const {
  const Matrix3r R = exact(body_->getWorldTransform().getBasis());
  DenseMatrix6 K = fluid_.cast<Real>();
  K.topLeftCorner<3, 3>() += exact(body_->getInvInertiaDiagLocal()).cwiseInverse().asDiagonal();
  K.bottomRightCorner<3, 3>() += Matrix3r::Identity() / body_->getInvMass();
  return reference::turned(K, R);
}

reference::DenseBody CoupledBody::dense(Real dt) const {
  reference::DenseBody result;
  result.fixed = fixed_;
  if (fixed_) return result;
  result.inertia = inertia();
  DenseVector6 wrench;
  wrench << exact(body_->getTotalTorque()), exact(body_->getTotalForce());
  result.free_velocity = velocity() + dt * reference::solved(result.inertia, wrench);
  // Rows use the velocity at half of the turning part, eq. (28).
  if (isAmbient())
    result.free_velocity += dt / 2 * reference::turningRate(result.inertia, velocity());
  return result;
}

double CoupledBody::gyroscopicTime(double part) const {
  const DenseMatrix6 K = inertia();
  const DenseVector6 u = velocity();
  const DenseVector6 rate = reference::turningRate(K, u);
  const Real turning = u.head<3>().norm();
  const Real time = std::sqrt(u.dot(K * u) / std::max<Real>(rate.dot(K * rate), 1e-30L));
  return part * static_cast<double>(std::min(time, 1 / turning));
}

double CoupledBody::error(const DenseVector6& expected, const DenseVector6& before) const {
  DenseVector6 units = DenseVector6::Ones();
  units.head<3>().setConstant(size_);
  const auto length = [&](const DenseVector6& u) { return u.cwiseProduct(units).norm(); };
  return static_cast<double>(length(velocity() - expected) /
                             std::max(length(expected), length(before)));
}

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
