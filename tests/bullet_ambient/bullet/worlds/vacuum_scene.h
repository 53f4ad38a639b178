#pragma once

#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/worlds/world_setups.h"

namespace ambient::test {

/// Scene of many features at once, built the same way each time: a stack hit by a
/// ball, five joints, a vehicle. Worlds that support soft bodies and multibodies get
/// some.
class VacuumScene {
 public:
  explicit VacuumScene(std::unique_ptr<WorldHost> host);
  ~VacuumScene();

  /// Adds a box that bodies() and state() leave out; place it in an island of its own.
  btRigidBody& addAside(const btVector3& position);
  void step(int count) { host_->step(1.0 / 120, count); }

  WorldHost& host() { return *host_; }
  /// Dynamic bodies without those of addAside().
  const std::vector<btRigidBody*>& bodies() const { return watched_; }
  /// Bodies of bodies() that hang on a joint.
  const std::vector<btRigidBody*>& jointed() const { return jointed_; }
  /// Poses and velocities of rigid bodies, nodes of soft bodies, links of multibodies; without
  /// bodies of addAside().
  std::vector<btScalar> state() const;
  /// Copies poses and velocities from another scene; keeps memory of joints and
  /// contacts.
  void takeStateOf(const VacuumScene& other);
  /// Distance that the ball of the stack has moved [m].
  btScalar ballTravel() const;

 private:
  btRigidBody& add(btScalar mass, btCollisionShape& shape, const btVector3& position);
  void addStack();
  void addJoints();
  void addVehicle();
  void addSoftBodies(btSoftRigidDynamicsWorld& world);
  void addMultiBody();

  std::unique_ptr<WorldHost> host_;
  btBoxShape floor_{btVector3(50, 50, 1)};
  btBoxShape box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
  btBoxShape chassis_{btVector3(2, 1, btScalar(0.4))};
  btBoxShape plate_{btVector3(btScalar(0.5), btScalar(0.4), btScalar(0.2))};
  btBoxShape link_{btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.4))};
  btSphereShape ball_{btScalar(0.4)};
  std::vector<btRigidBody*> watched_;
  std::vector<btRigidBody*> jointed_;
  std::unique_ptr<btVehicleRaycaster> raycaster_;
  std::unique_ptr<btRaycastVehicle> vehicle_;
  std::vector<std::unique_ptr<btSoftBody>> soft_bodies_;
  btMultiBody* chain_ = nullptr;
  btRigidBody* hitting_ball_ = nullptr;
  WorldContents contents_{host_->world()};
};

/// Compares bit for bit: -0 differs from 0.
bool sameBits(const std::vector<btScalar>& a, const std::vector<btScalar>& b);

}  // namespace ambient::test
