#include "tests/golden/golden_world.h"

#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {

GoldenWorld::GoldenWorld(Kind kind) {
  if (kind == Kind::kMultiBodies) {
    auto solver = std::make_unique<btMultiBodyConstraintSolver>();
    world_ = std::make_unique<btMultiBodyDynamicsWorld>(&parts_.dispatcher, &parts_.broadphase,
                                                        solver.get(), &parts_.configuration);
    solver_ = std::move(solver);
  } else {
    solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&parts_.dispatcher, &parts_.broadphase,
                                                       solver_.get(), &parts_.configuration);
  }
  world_->setGravity({0, 0, bt(-9.81)});
  contents_.emplace(*world_);
  fluid_.emplace(*world_);
  fluid_->setReport([](const std::string&) {});  // steps that are too long are meant to be
}

btRigidBody& GoldenWorld::addDry(const GoldenBody& def) {
  const bool is_static = def.mass == 0;
  const Vector3 moments = is_static ? Vector3(Vector3::Zero()) : def.moments;
  const btQuaternion turn(bt(0.1), bt(-0.2), bt(0.3), bt(0.9));
  const btTransform pose(is_static ? btQuaternion::getIdentity() : turn.normalized(),
                         toBullet(def.position));
  btRigidBody& body =
      contents_->add(def.mass, toBullet(moments), def.shape ? *def.shape : no_shape_, pose);
  body.setLinearVelocity(toBullet(def.twist.linear));
  body.setAngularVelocity(toBullet(def.twist.angular));
  return body;
}

btRigidBody& GoldenWorld::add(const GoldenBody& def, const AttachDef& attach) {
  btRigidBody& body = addDry(def);
  fluid_->add(body, attach);
  return body;
}

btTypedConstraint& GoldenWorld::addJoint(btTypedConstraint* joint) {
  return contents_->join(std::unique_ptr<btTypedConstraint>(joint));
}

void GoldenWorld::addChain(const Vector3& top) {
  const btVector3 moments(bt(0.02), bt(0.03), bt(0.04)), down(0, 0, bt(-0.3));
  auto chain = std::make_unique<btMultiBody>(2, bt(1), moments, true, false);
  chain_ = chain.get();
  chain_->setBasePos(toBullet(top));
  for (int link = 0; link < 2; ++link)
    chain_->setupRevolute(link, bt(0.8), moments, link - 1, btQuaternion::getIdentity(),
                          {0, 1, bt(0.2)}, down / 2, down / 2);
  chain_->finalizeMultiDof();
  chain_->setJointVel(0, bt(-2));
  contents_->take(std::move(chain));
  for (int link = 0; link < 2; ++link) {
    auto* collider = new btMultiBodyLinkCollider(chain_, link);  // leaves with the chain
    collider->setCollisionShape(&ball_);
    collider->setWorldTransform(
        btTransform(btQuaternion::getIdentity(), toBullet(top) + down * (bt(0.5) + bt(link))));
    world_->addCollisionObject(collider, btBroadphaseProxy::DefaultFilter,
                               btBroadphaseProxy::AllFilter);
    chain_->getLink(link).m_collider = collider;
  }
}

void GoldenWorld::traceStep() {
  const auto add = [&](const btVector3& v) {
    for (int i = 0; i < 3; ++i) trace_.add(v[i]);
  };
  for (const auto& body : contents_->bodies()) {
    const btTransform& pose = body->getWorldTransform();
    add(pose.getOrigin());
    for (int i = 0; i < 3; ++i) add(pose.getBasis()[i]);
    add(body->getLinearVelocity());
    add(body->getAngularVelocity());
  }
  for (const auto& joint : contents_->joints()) trace_.add(joint->getAppliedImpulse());
  for (int i = 0; chain_ && i < chain_->getNumLinks(); ++i) {
    trace_.add(chain_->getJointPos(i));
    trace_.add(chain_->getJointVel(i));
  }
}

GoldenRecord GoldenWorld::run(int steps, const std::function<void(int)>& before) {
  for (int i = 0; i < steps; ++i) {
    before(i);
    world_->stepSimulation(bt(kStep), 0, bt(kStep));
    traceStep();
  }
  GoldenRecord record{"", trace_.hash(), {}};
  record.sample << toVector3(body(0).getWorldTransform().getOrigin()),
      toVector3(body(0).getLinearVelocity());
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
  makeSurfaceForm(body);
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(body);
  attach.medium = water();
  attach.flow.law = PressureLaw::kPublished;
  attach.fluid_frame.rotation = arbitrary.rotation();
  attach.fluid_frame.translation = {0.02, 0.01, -0.03};
  return attach;
}

std::vector<GoldenRun> goldenRuns() {
  std::vector<GoldenRun> all;
  for (const auto& runs : {goldenFlights(), goldenContacts(), goldenJoints()})
    all.insert(all.end(), runs.begin(), runs.end());
  return all;
}

}  // namespace ambient::test
