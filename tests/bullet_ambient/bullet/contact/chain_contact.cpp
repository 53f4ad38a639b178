#include "tests/bullet_ambient/bullet/contact/chain_contact.h"

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace ambient::test {

ChainTask::ChainTask(Arbitrary& arbitrary, bool has_fixed_base, int link)
    : body_(CoupledBody::random(arbitrary, arbitraryRatio(arbitrary))), link_(link) {
  RobotDef def;
  def.joints = Joints::kSmooth;
  def.has_fixed_base = has_fixed_base;
  robot_ = arbitraryRobot(arbitrary, def);
  for (int i = -1; i < robot_->getNumLinks(); ++i)
    colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(robot_.get(), i));
  // Repeats the world's preparation before its solver call; advances no time.
  RobotWorld::moveColliders(*robot_);
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btScalar> scalars;
  btAlignedObjectArray<btMatrix3x3> matrices;
  robot_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scalars, vectors, matrices, false,
                                                               false, false);
  point_ = exact(robot_->localPosToWorld(link, {0, 0, 0})) + arbitrary.vector(0.15).cast<Real>();
  const Vector3 centre = point_.cast<double>() + arbitrary.vector(body_.size() / 2);
  btTransform pose = body_.body().getWorldTransform();
  pose.setOrigin(toBt(centre));
  body_.body().setWorldTransform(pose);
}

void ChainTask::touchAlong(const btVector3& normal_or_opposite, bool body_is_a) {
  body_is_a_ = body_is_a;
  btCollisionObject* a = &body_.body();
  btCollisionObject* b = colliders_[static_cast<std::size_t>(link_ + 1)].get();
  if (!body_is_a) std::swap(a, b);
  manifold_ = std::make_unique<btPersistentManifold>(a, b, 0, btScalar(1), btScalar(1));
  const btVector3 at = toBt(point_.cast<double>());
  point_ = exact(at);
  for (const btScalar sign : {btScalar(1), btScalar(-1)}) {
    btManifoldPoint point({0, 0, 0}, {0, 0, 0}, sign * normal_or_opposite, 0);
    point.m_positionWorldOnA = point.m_positionWorldOnB = at;
    manifold_->clearManifold();
    manifold_->addManifoldPoint(point);
    if (approach() < 0) return;
  }
}

reference::DenseRow ChainTask::oriented(reference::DenseRow row) const {
  row.body_a = denseBody();
  row.body_b = link_ + 1;
  if (!body_is_a_) {
    row.jacobian_a *= -1;
    row.jacobian_b *= -1;
  }
  return row;
}

reference::DenseRow ChainTask::row(const Vector3r& direction) const {
  return oriented(reference::pointRow(direction,
                                      point_ - exact(body_.body().getWorldTransform().getOrigin()),
                                      point_ - exact(robot_->localPosToWorld(link_, {0, 0, 0}))));
}

reference::DenseRow ChainTask::spinRow(const Vector3r& direction) const {
  return oriented(reference::spinRow(direction));
}

Real ChainTask::approach() const {
  const reference::DenseRow r = row(exact(manifold_->getContactPoint(0).m_normalWorldOnB));
  return r.jacobian_a.dot(body_.velocity()) +
         r.jacobian_b.dot(twistsOf(*robot_)[static_cast<std::size_t>(link_ + 1)]);
}

DenseRobot ChainTask::dense(Real dt) const {
  static const RobotWorld nobody;  // the robot is in no fluid
  DenseRobot dense = denseRobot(*robot_, nobody.fluid);
  dense.bodies.push_back(body_.dense(dt));
  return dense;
}

bool ChainTask::solve(const btContactSolverInfo& info, btMultiBodyConstraint* joint) {
  const auto members = std::make_shared<AmbientBodies>();
  body_.attachTo(*members);
  MultiBody::Ambient ambient(members);
  std::vector<btCollisionObject*> bodies = {&body_.body()};
  for (const auto& collider : colliders_) bodies.push_back(collider.get());
  btPersistentManifold* manifolds[] = {manifold_.get()};
  ambient.solver.solveMultiBodyGroup(bodies.data(), static_cast<int>(bodies.size()), manifolds,
                                     manifold_ ? 1 : 0, nullptr, 0, joint ? &joint : nullptr,
                                     joint ? 1 : 0, info, nullptr, nullptr);
  robot_->processDeltaVeeMultiDof2();  // the world's next call
  return hasFinished(ambient.solver, info);
}

double BeforeChain::error(const ChainTask& task, const reference::DenseSolution& expected) const {
  return std::max(
      task.body().error(expected.velocities[static_cast<std::size_t>(task.denseBody())], body),
      twistError(task.robot(), expected.velocities, robot));
}

ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base) {
  const int link = static_cast<int>(arbitrary.between(has_fixed_base ? 1 : 0, 4)) - 1;
  return {arbitrary, has_fixed_base, std::min(link, 2)};
}

double pushedTime(Arbitrary& arbitrary, const ChainTask& task) {
  const CoupledBody& body = task.body();
  const double dt = body.gyroscopicTime(0.05);
  const double push = 0.05 / (dt * static_cast<double>(body.body().getInvMass()));
  body.body().applyCentralForce(toBt(arbitrary.vector(push)));
  body.body().applyTorque(toBt(arbitrary.vector(push * body.size())));
  return dt;
}

btContactSolverInfo chainSettings(double dt) {
  btContactSolverInfo info = convergingSettings(dt);
  info.m_numIterations = 300;
  return info;
}

}  // namespace ambient::test
