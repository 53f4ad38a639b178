#include "tests/bullet_ambient/bullet/contact/coupled_body.h"

#include <algorithm>
#include <cmath>

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
  AttachDef def;
  def.fluid_body = fluid_body;
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

}  // namespace ambient::test
