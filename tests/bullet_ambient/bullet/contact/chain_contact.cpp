#include "tests/bullet_ambient/bullet/contact/chain_contact.h"

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace ambient::test {

ChainTask::ChainTask(Arbitrary& arbitrary, CoupledBody body, LinkChain chain, int link_body)
    : body_(std::move(body)), chain_(std::move(chain)), link_body_(link_body) {
  point_ = chain_.centre(link_body) + arbitrary.vector(0.15).cast<Real>();
  const Vector3 centre = point_.cast<double>() + arbitrary.vector(body_.size() / 2);
  btTransform pose = body_.body().getWorldTransform();
  pose.setOrigin(toBt(centre));
  body_.body().setWorldTransform(pose);
}

void ChainTask::touchAlong(const btVector3& normal_or_opposite, bool body_is_a) {
  body_is_a_ = body_is_a;
  btCollisionObject* a = &body_.body();
  btCollisionObject* b = &chain_.collider(link_body_);
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
  row.body_b = 1 + link_body_;
  if (!body_is_a_) {
    row.jacobian_a *= -1;
    row.jacobian_b *= -1;
  }
  return row;
}

reference::DenseRow ChainTask::row(const Vector3r& direction) const {
  return oriented(reference::pointRow(direction,
                                      point_ - exact(body_.body().getWorldTransform().getOrigin()),
                                      point_ - chain_.centre(link_body_)));
}

reference::DenseRow ChainTask::spinRow(const Vector3r& direction) const {
  return oriented(reference::spinRow(direction));
}

Real ChainTask::approach() const {
  const reference::DenseRow r = row(exact(manifold_->getContactPoint(0).m_normalWorldOnB));
  return r.jacobian_a.dot(body_.velocity()) + r.jacobian_b.dot(chain_.velocity(link_body_));
}

std::vector<reference::DenseBody> ChainTask::dense(Real dt) const {
  std::vector<reference::DenseBody> bodies = chain_.dense();
  bodies.insert(bodies.begin(), body_.dense(dt));
  return bodies;
}

bool ChainTask::solve(const btContactSolverInfo& info, btMultiBodyConstraint* joint) {
  const auto members = std::make_shared<AmbientBodies>();
  body_.attachTo(*members);
  MultiBody::Ambient ambient(members);
  std::vector<btCollisionObject*> bodies = {&body_.body()};
  for (int i = 0; i < LinkChain::kBodies; ++i) bodies.push_back(&chain_.collider(i));
  btPersistentManifold* manifolds[] = {manifold_.get()};
  ambient.solver.solveMultiBodyGroup(bodies.data(), static_cast<int>(bodies.size()), manifolds,
                                     manifold_ ? 1 : 0, nullptr, 0, joint ? &joint : nullptr,
                                     joint ? 1 : 0, info, nullptr, nullptr);
  chain_.multibody().processDeltaVeeMultiDof2();  // the world's next call
  return hasFinished(ambient.solver, info);
}

double BeforeChain::error(const ChainTask& task, const reference::DenseSolution& expected) const {
  return std::max(task.body().error(expected.velocities[0], body),
                  task.chain().error(expected.velocities, 1, chain));
}

ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base, int link_body) {
  CoupledBody body = CoupledBody::random(arbitrary, arbitraryRatio(arbitrary));
  LinkChain chain = LinkChain::random(arbitrary, has_fixed_base);
  return {arbitrary, std::move(body), std::move(chain), link_body};
}

ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base) {
  const int lowest = has_fixed_base ? 1 : 0;
  const int link_body = std::min(LinkChain::kBodies - 1,
                                 static_cast<int>(arbitrary.between(lowest, LinkChain::kBodies)));
  return arbitraryChainTask(arbitrary, has_fixed_base, link_body);
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
