#include "tests/golden/golden_world.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {

GoldenWorld::GoldenWorld(Kind kind) {
  if (kind == Kind::kMultiBodies) {
    auto solver = std::make_unique<btMultiBodyConstraintSolver>();
    world_ = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher_, &broadphase_, solver.get(),
                                                        &configuration_);
    solver_ = std::move(solver);
  } else {
    solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(),
                                                       &configuration_);
  }
  world_->setGravity({0, 0, bt(-9.81)});
  fluid_.emplace(*world_);
  fluid_->setReport([](const std::string&) {});  // steps that are too long are meant to be
}

GoldenWorld::~GoldenWorld() {
  for (const auto& joint : joints_) world_->removeConstraint(joint.get());
  for (const auto& body : bodies_) world_->removeRigidBody(body.get());
  for (const auto& link : links_) world_->removeCollisionObject(link.get());
  if (chain_) static_cast<btMultiBodyDynamicsWorld&>(*world_).removeMultiBody(chain_.get());
}

btRigidBody& GoldenWorld::addDry(const GoldenBody& def) {
  btCollisionShape* shape = def.shape ? def.shape : &no_shape_;
  const Vector3 moments = def.mass > 0 ? def.moments : Vector3(Vector3::Zero());
  bodies_.push_back(std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(bt(def.mass), nullptr, shape, toBullet(moments))));
  btRigidBody& body = *bodies_.back();
  const btQuaternion turn(bt(0.1), bt(-0.2), bt(0.3), bt(0.9));
  const bool is_static = def.mass == 0;
  body.setWorldTransform(btTransform(is_static ? btQuaternion::getIdentity() : turn.normalized(),
                                     toBullet(def.position)));
  body.setLinearVelocity(toBullet(def.twist.linear));
  body.setAngularVelocity(toBullet(def.twist.angular));
  world_->addRigidBody(&body);
  return body;
}

btRigidBody& GoldenWorld::add(const GoldenBody& def, const AttachDef& attach) {
  btRigidBody& body = addDry(def);
  fluid_->add(body, attach);
  return body;
}

btTypedConstraint& GoldenWorld::addJoint(btTypedConstraint* joint) {
  joints_.emplace_back(joint);
  world_->addConstraint(joint, true);
  return *joint;
}

void GoldenWorld::addChain(const Vector3& top) {
  const btVector3 moments(bt(0.02), bt(0.03), bt(0.04)), down(0, 0, bt(-0.3));
  chain_ = std::make_unique<btMultiBody>(2, bt(1), moments, true, false);
  chain_->setBasePos(toBullet(top));
  for (int link = 0; link < 2; ++link)
    chain_->setupRevolute(link, bt(0.8), moments, link - 1, btQuaternion::getIdentity(),
                          {0, 1, bt(0.2)}, down / 2, down / 2);
  chain_->finalizeMultiDof();
  chain_->setJointVel(0, bt(-2));
  auto& world = static_cast<btMultiBodyDynamicsWorld&>(*world_);
  world.addMultiBody(chain_.get());
  for (int link = 0; link < 2; ++link) {
    links_.push_back(std::make_unique<btMultiBodyLinkCollider>(chain_.get(), link));
    btMultiBodyLinkCollider& collider = *links_.back();
    collider.setCollisionShape(&ball_);
    collider.setWorldTransform(
        btTransform(btQuaternion::getIdentity(), toBullet(top) + down * (bt(0.5) + bt(link))));
    world.addCollisionObject(&collider, btBroadphaseProxy::DefaultFilter,
                             btBroadphaseProxy::AllFilter);
    chain_->getLink(link).m_collider = &collider;
  }
}

void GoldenWorld::traceStep() {
  const auto add = [&](const btVector3& v) {
    for (int i = 0; i < 3; ++i) trace_.add(v[i]);
  };
  for (const auto& body : bodies_) {
    const btTransform& pose = body->getWorldTransform();
    add(pose.getOrigin());
    for (int i = 0; i < 3; ++i) add(pose.getBasis()[i]);
    add(body->getLinearVelocity());
    add(body->getAngularVelocity());
  }
  for (const auto& joint : joints_) trace_.add(joint->getAppliedImpulse());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    trace_.add(chain_->getJointPos(static_cast<int>(i)));
    trace_.add(chain_->getJointVel(static_cast<int>(i)));
  }
}

GoldenRecord GoldenWorld::run(int steps, const std::function<void(int)>& before) {
  for (int i = 0; i < steps; ++i) {
    before(i);
    world_->stepSimulation(bt(kStep), 0, bt(kStep));
    traceStep();
  }
  GoldenRecord record{"", trace_.hash(), {}};
  record.sample << toVector3(bodies_.front()->getWorldTransform().getOrigin()),
      toVector3(bodies_.front()->getLinearVelocity());
  return record;
}

AttachDef symmetricInWater() {
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid({0.3, 0.2, 0.1}, 2));
  attach.medium = water();
  attach.flow.law = PressureLaw::kPublished;
  return attach;
}

AttachDef bumpyInWater() {
  Arbitrary arbitrary(7);
  FluidBody body;
  body.name = "bumpy";
  body.added_mass = 0.002 * arbitrary.positiveDefinite();
  body.added_mass.topLeftCorner<3, 3>() *= 0.04;
  body.added_mass.topRightCorner<3, 3>() *= 0.2;
  body.added_mass.bottomLeftCorner<3, 3>() *= 0.2;
  const FaceTable faces = arbitrary.body(2);
  for (std::size_t i = 0; i < faces.size(); ++i)
    body.faces.add(faces.normal(i), 0.2 * faces.centroid(i), 0.04 * faces.area[i]);
  body.area = totalArea(body.faces);
  body.volume = 0.001;
  body.centre_of_volume = {0.01, -0.02, 0.015};
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(body);
  attach.medium = water();
  attach.flow.law = PressureLaw::kPublished;
  attach.fluid_frame.rotation = arbitrary.rotation();
  attach.fluid_frame.translation = {0.02, 0.01, -0.03};
  return attach;
}

}  // namespace ambient::test
