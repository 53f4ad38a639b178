#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/world/fluid.h"
#include "demos/simulation/collision_shape.h"
#include "demos/simulation/scene_robot.h"

namespace ambient {

/// One body in the world. B: Bullet's body frame, origin at the centre of mass, principal axes. S:
/// frame of the shape.
struct WorldBody {
  std::string name;
  MotionSample start;
  Matrix3 R_SB = Matrix3::Identity();  // B's axes to S's
  CollisionShape shape;
  std::unique_ptr<btRigidBody> body;  // null: the body is a link of a robot
  std::optional<SceneLink> link;
  std::shared_ptr<const FluidBody> fluid_body;
  std::optional<Immersed> immersed;
};

/// Bullet's world and solver of a scene: a btMultiBodyDynamicsWorld if it takes robots.
struct BulletWorld {
  std::unique_ptr<btConstraintSolver> solver;
  std::unique_ptr<btDiscreteDynamicsWorld> world;
  btMultiBodyDynamicsWorld* multi_body_world = nullptr;
};

class SimulationWorld {
 public:
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  BulletWorld bullet;
  Fluid fluid;
  std::vector<WorldBody> bodies;
  std::vector<std::unique_ptr<SceneRobot>> robots;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  LoadLaw own_law;  ///< law of all bodies; empty: this library's law
  std::string report;
  double time_step = 0;
  std::string file;  ///< file of the scene; begins every message
  long long steps = 0;

  SimulationWorld(const Scene& scene, const std::vector<PreparedBody>& prepared, bool takes_robots);
  ~SimulationWorld();

  void addRobots(const Scene& scene, const std::vector<PreparedBody>& prepared);
  double time() const { return static_cast<double>(steps) * time_step; }
  void step();
  std::shared_ptr<const FluidBody> findFluidBody(const std::string& name) const;
  MotionSample sample(const WorldBody& of) const;
  AmbientCounters counters(const WorldBody& of) const;
  /// Applies a wrench during the next step: about the centre of mass, axes of W.
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
