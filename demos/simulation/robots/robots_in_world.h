#pragma once

#include <memory>

#include "bullet_ambient/spatial/vector_types.h"
#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/prepared_body.h"
#include "demos/simulation/scene_body_cache.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;

namespace ambient {

class SceneRobot;

/// Robots of a scene in Bullet's world, in the order of the scene. An interface, so that a build
/// without robots (BULLET_AMBIENT_WHOLE_DEMO=OFF) links nothing of them.
class RobotsInWorld {
 public:
  virtual ~RobotsInWorld() = default;

  virtual std::size_t count() const = 0;
  virtual SceneRobot& robot(std::size_t index) const = 0;
  /// @throws std::runtime_error as the constructor of Robot
  virtual void add(const RobotDef& def, btMultiBodyDynamicsWorld& world) = 0;
  /// Takes the robots from `first` on out of their world.
  virtual void removeFrom(std::size_t first) = 0;
  /// Sets the motors' targets for the step from `time` to time + time_step [s], of the robots from
  /// `first` on.
  virtual void prepareStep(std::size_t first, double time, double time_step) = 0;

  virtual btMultiBody& multiBody(const SceneLink& link) const = 0;
  /// Rotation from the axes of the link's body in Bullet to the link's own.
  virtual Matrix3 bodyToLink(const SceneLink& link) const = 0;
  /// Motion of a link, see SceneRobot::sample().
  virtual MotionSample sample(const SceneLink& link) const = 0;
};

/// Returns null in a build without robots: readScene() refuses them there.
std::unique_ptr<RobotsInWorld> makeRobotsInWorld();

/// Prepares the link of a robot, with the fluid body that its <ambient> element names, else that of
/// its collision shape.
PreparedBody prepareLink(const Scene& scene, const BodyDef& def, SceneBodyCache& fluid_bodies);

}  // namespace ambient
