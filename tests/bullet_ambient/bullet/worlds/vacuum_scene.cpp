#include "tests/bullet_ambient/bullet/worlds/vacuum_scene.h"

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <cstring>

#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

void append(std::vector<btScalar>& state, const btVector3& v) {
  state.insert(state.end(), {v.x(), v.y(), v.z()});
}

constexpr int kLinks = 4;

}  // namespace

VacuumScene::VacuumScene(std::unique_ptr<WorldHost> host) : host_(std::move(host)) {
  host_->world().setGravity({0, 0, bt(-9.81)});
  add(0, floor_, {0, 0, -1}).setRestitution(bt(0.3));
  addStack();
  addJoints();
  addVehicle();
  if (auto* world = host_->softWorld()) addSoftBodies(*world);
  if (host_->multiBodyWorld()) addMultiBody();
}

VacuumScene::~VacuumScene() {
  host_->world().removeAction(vehicle_.get());
  for (const auto& body : soft_bodies_) host_->softWorld()->removeSoftBody(body.get());
}

btRigidBody& VacuumScene::add(btScalar mass, btCollisionShape& shape, const btVector3& position) {
  btRigidBody& body = contents_.add(static_cast<double>(mass), shape,
                                    btTransform(btQuaternion::getIdentity(), position));
  if (mass > 0) watched_.push_back(&body);
  return body;
}

btRigidBody& VacuumScene::addAside(const btVector3& position) {
  btRigidBody& body = add(1, box_, position);
  watched_.pop_back();
  return body;
}

void VacuumScene::addStack() {
  for (int i = 0; i < 4; ++i) add(1, box_, {0, 0, bt(0.6 + 1.1 * i)});
  hitting_ball_ = &add(2, ball_, {-6, bt(0.1), 2});
  hitting_ball_->setLinearVelocity({9, 0, 1});
  hitting_ball_->setRestitution(bt(0.5));
  hitting_ball_->setRollingFriction(bt(0.01));
}

void VacuumScene::addJoints() {
  const btVector3 up(0, 0, bt(0.7));
  const btTransform frame(btQuaternion::getIdentity(), up);
  for (int kind = 0; kind < 5; ++kind) {
    btRigidBody& body = add(1, plate_, {bt(4 + 3 * kind), 6, 4});
    jointed_.push_back(&body);
    body.setAngularVelocity({1, 2, bt(0.5)});
    if (kind == 0) contents_.take(std::make_unique<btPoint2PointConstraint>(body, up));
    if (kind == 1) {
      const btVector3 axis(0, 1, 0);
      contents_.take(std::make_unique<btHingeConstraint>(body, up, axis))
          .enableAngularMotor(true, 2, bt(0.1));
    }
    if (kind == 2) contents_.take(std::make_unique<btSliderConstraint>(body, frame, true));
    if (kind == 3) {
      // Bullet's constructor for one body would fix it to the origin of the world.
      contents_.take(std::make_unique<btConeTwistConstraint>(
          body, btTypedConstraint::getFixedBody(), frame, body.getWorldTransform() * frame));
    }
    if (kind == 4) {
      auto& spring = contents_.take(std::make_unique<btGeneric6DofSpring2Constraint>(body, frame));
      spring.enableSpring(2, true);
      spring.setStiffness(2, 50);
    }
  }
}

void VacuumScene::addVehicle() {
  btRigidBody& body = add(800, chassis_, {0, -12, bt(1.2)});
  body.setActivationState(DISABLE_DEACTIVATION);
  btRaycastVehicle::btVehicleTuning tuning;
  raycaster_ = std::make_unique<btDefaultVehicleRaycaster>(&host_->world());
  vehicle_ = std::make_unique<btRaycastVehicle>(tuning, &body, raycaster_.get());
  vehicle_->setCoordinateSystem(1, 2, 0);
  for (int i = 0; i < 4; ++i) {
    const btVector3 corner(i < 2 ? bt(1.5) : bt(-1.5), i % 2 == 0 ? 1 : -1, 0);
    vehicle_->addWheel(corner, {0, 0, -1}, {0, -1, 0}, bt(0.6), bt(0.4), tuning, i < 2);
    vehicle_->applyEngineForce(i < 2 ? 0 : 500, i);
    if (i < 2) vehicle_->setSteeringValue(bt(0.2), i);
  }
  host_->world().addAction(vehicle_.get());
}

// Adds a ball on a sheet held at its corners, and a soft ball that falls onto the floor.
void VacuumScene::addSoftBodies(btSoftRigidDynamicsWorld& world) {
  world.getWorldInfo().m_gravity = world.getGravity();
  soft_bodies_.emplace_back(btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), {10, -6, 2},
                                                           {14, -6, 2}, {10, -2, 2}, {14, -2, 2}, 9,
                                                           9, 1 + 2 + 4 + 8, true));
  soft_bodies_.emplace_back(
      btSoftBodyHelpers::CreateEllipsoid(world.getWorldInfo(), {20, -4, 2}, {1, 1, 1}, 60));
  for (const auto& body : soft_bodies_) {
    body->setTotalMass(2);
    world.addSoftBody(body.get());
  }
  add(1, ball_, {bt(12.1), bt(-4.2), 3});
}

// Adds a chain that swings from the ceiling into a box.
void VacuumScene::addMultiBody() {
  const btVector3 half(0, 0, bt(-0.4));
  btVector3 inertia;
  link_.calculateLocalInertia(1, inertia);
  auto chain = std::make_unique<btMultiBody>(kLinks, 0, btVector3(0, 0, 0), true, true);
  chain_ = chain.get();
  chain_->setBasePos({12, -4, 4});
  for (int i = 0; i < kLinks; ++i) {
    chain_->setupRevolute(i, 1, inertia, i - 1, btQuaternion::getIdentity(), {0, 1, 0},
                          i == 0 ? btVector3(0, 0, 0) : half, half, true);
  }
  chain_->finalizeMultiDof();
  chain_->setJointPos(0, bt(1.2));
  contents_.take(std::move(chain));
  for (int i = 0; i < kLinks; ++i) contents_.addCollider(*chain_, i, link_);
  add(1, box_, {12, -4, bt(0.5)});
}

std::vector<btScalar> VacuumScene::state() const {
  std::vector<btScalar> state;
  for (const btRigidBody* body : watched_) {
    append(state, body->getWorldTransform().getOrigin());
    for (int i = 0; i < 3; ++i) append(state, body->getWorldTransform().getBasis()[i]);
    append(state, body->getLinearVelocity());
    append(state, body->getAngularVelocity());
  }
  for (const auto& body : soft_bodies_) {
    for (int i = 0; i < body->m_nodes.size(); ++i) {
      append(state, body->m_nodes[i].m_x);
      append(state, body->m_nodes[i].m_v);
    }
  }
  for (int i = 0; chain_ && i < kLinks; ++i) {
    state.insert(state.end(), {chain_->getJointPos(i), chain_->getJointVel(i)});
  }
  return state;
}

void VacuumScene::takeStateOf(const VacuumScene& other) {
  for (std::size_t i = 0; i < contents_.bodies().size(); ++i) {
    const btRigidBody& from = *other.contents_.bodies()[i];
    btRigidBody& to = *contents_.bodies()[i];
    to.setWorldTransform(from.getWorldTransform());
    to.updateInertiaTensor();
    to.setLinearVelocity(from.getLinearVelocity());
    to.setAngularVelocity(from.getAngularVelocity());
    to.setInterpolationWorldTransform(from.getInterpolationWorldTransform());
    to.setInterpolationLinearVelocity(from.getInterpolationLinearVelocity());
    to.setInterpolationAngularVelocity(from.getInterpolationAngularVelocity());
    to.forceActivationState(from.getActivationState());
    to.setDeactivationTime(from.getDeactivationTime());
  }
  for (std::size_t i = 0; i < soft_bodies_.size(); ++i) {
    for (int node = 0; node < soft_bodies_[i]->m_nodes.size(); ++node) {
      soft_bodies_[i]->m_nodes[node].m_x = other.soft_bodies_[i]->m_nodes[node].m_x;
      soft_bodies_[i]->m_nodes[node].m_q = other.soft_bodies_[i]->m_nodes[node].m_q;
      soft_bodies_[i]->m_nodes[node].m_v = other.soft_bodies_[i]->m_nodes[node].m_v;
    }
  }
  for (int i = 0; chain_ && i < kLinks; ++i) {
    chain_->setJointPos(i, other.chain_->getJointPos(i));
    chain_->setJointVel(i, other.chain_->getJointVel(i));
  }
}

btScalar VacuumScene::ballTravel() const {
  return (hitting_ball_->getWorldTransform().getOrigin() - btVector3(-6, bt(0.1), 2)).length();
}

bool sameBits(const std::vector<btScalar>& a, const std::vector<btScalar>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(btScalar)) == 0;
}

}  // namespace ambient::test
