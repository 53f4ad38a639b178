#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/ambient_action.h"
#include "bullet_ambient/bullet/ambient_registry.h"
#include "demos/simulation/collision_shape.h"
#include "demos/simulation/scene_robot.h"
#include "demos/simulation/simulation.h"

namespace ambient {

/// One body in the world. Bullet's body frame B has its origin at the centre of mass and principal
/// axes; S is the shape's frame.
struct WorldBody {
  std::string name;
  MotionSample start;
  Matrix3 R_SB = Matrix3::Identity();  // B's axes to S's
  CollisionShape shape;
  std::unique_ptr<btRigidBody> body;  // null: a link of a robot
  std::optional<SceneLink> link;
  std::shared_ptr<const FluidBody> fluid_body;
  bool is_ambient = false;
};

/// What steps a scene: of multibodies where there are robots.
struct BulletWorld {
  std::unique_ptr<btConstraintSolver> solver;
  std::unique_ptr<btDiscreteDynamicsWorld> world;
  btMultiBodyDynamicsWorld* multi_body_world = nullptr;
};

struct Simulation::World {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  AmbientRegistry registry;
  AmbientAction action{registry};
  BulletWorld bullet;
  std::vector<WorldBody> bodies;
  std::vector<std::unique_ptr<SceneRobot>> robots;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  LoadLaw own_law;  ///< of all bodies; empty: this library's
  std::string report;
  double time_step = 0;
  std::string file;  ///< of the scene; begins every message
  long long steps = 0;

  World(const Scene& scene, const std::vector<PreparedBody>& prepared);
  ~World();

  double time() const { return static_cast<double>(steps) * time_step; }
  void step();
  std::shared_ptr<const FluidBody> findFluidBody(const std::string& name) const;
  MotionSample sample(const WorldBody& of) const;
  AmbientCounters counters(const WorldBody& of) const;
  /// About its centre of mass, in W, during the next step.
  void apply(const WorldBody& to, const Wrench& wrench);
  void setMedium(const WorldBody& of, const Medium& medium);

 private:
  void add(const Scene& scene, const BodyDef& def, const PreparedBody& prepared);
  void add(const RobotDef& def);
  void add(const JointDef& def);
  void attach(WorldBody& added, const AttachDef& def);
  btRigidBody& find(const std::string& name) const;
  btMultiBody& multiBodyOf(const WorldBody& link) const;
};

}  // namespace ambient
