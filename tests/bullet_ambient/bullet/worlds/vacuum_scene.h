#pragma once

#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/worlds/world_setups.h"

namespace ambient::test {

/// A scene in which all that a world offers happens at once, built the same way each time: a stack
/// that is hit by a ball, five joints, a vehicle; soft bodies and multibodies in the worlds that
/// take them.
class VacuumScene {
 public:
  explicit VacuumScene(std::unique_ptr<WorldHost> host);
  ~VacuumScene();

  /// A unit cube and what stands beside the rest, on the same floor, in an island of its own.
  btRigidBody& addAside(const btVector3& position);
  void step(int count) { host_->step(1.0 / 120, count); }

  WorldHost& host() { return *host_; }
  /// Every dynamic body but those aside.
  const std::vector<btRigidBody*>& bodies() const { return watched_; }
  /// Those of them that hang on a joint.
  const std::vector<btRigidBody*>& jointed() const { return jointed_; }
  /// Poses and velocities of rigid bodies, nodes of soft bodies, links of multibodies; without
  /// those aside.
  std::vector<btScalar> state() const;
  /// Poses and velocities of another scene become those of this one; what joints and contacts
  /// remember stays.
  void takeStateOf(const VacuumScene& other);
  /// How far the ball of the stack has come [m].
  btScalar ballTravel() const;

 private:
  btRigidBody& add(btScalar mass, btCollisionShape& shape, const btVector3& position);
  void addStack();
  void addJoints();
  void addVehicle();
  void addSoftBodies(btSoftRigidDynamicsWorld& world);
  void addMultiBody(btMultiBodyDynamicsWorld& world);
  void keep(btTypedConstraint* joint);

  std::unique_ptr<WorldHost> host_;
  btBoxShape floor_{btVector3(50, 50, 1)};
  btBoxShape box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
  btBoxShape chassis_{btVector3(2, 1, btScalar(0.4))};
  btBoxShape plate_{btVector3(btScalar(0.5), btScalar(0.4), btScalar(0.2))};
  btBoxShape link_{btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.4))};
  btSphereShape ball_{btScalar(0.4)};
  std::vector<std::unique_ptr<btRigidBody>> owned_;
  std::vector<btRigidBody*> watched_;
  std::vector<btRigidBody*> jointed_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::unique_ptr<btVehicleRaycaster> raycaster_;
  std::unique_ptr<btRaycastVehicle> vehicle_;
  std::vector<std::unique_ptr<btSoftBody>> soft_bodies_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::unique_ptr<btMultiBody> chain_;
  btRigidBody* hitting_ball_ = nullptr;
};

/// Bit for bit, so that -0 is not 0.
bool sameBits(const std::vector<btScalar>& a, const std::vector<btScalar>& b);

}  // namespace ambient::test
