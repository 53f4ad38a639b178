#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/robot/robot.h"

class btDynamicsWorld;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// A robot of rigid bodies with constraints, for worlds without multibodies: one body per link,
/// btFixedConstraint, btHingeConstraint or btSliderConstraint per joint, with its limits. Joints
/// give way a little, as Bullet's constraints do; friction, damping and mimics are left out.
/// Attach its bodies as any others, with shape(link).in_body or linkInBody(link).
class RigidRobot {
 public:
  /// @throws std::runtime_error in one line as Robot; for a planar joint; for a link without mass,
  /// but for the root of a fixed base.
  explicit RigidRobot(RobotModel model, const RobotSettings& settings = {});
  /// Leaves its world.
  ~RigidRobot();
  RigidRobot(const RigidRobot&) = delete;
  RigidRobot& operator=(const RigidRobot&) = delete;

  /// The world must outlive the robot, or leaveWorld() be called before. @pre it is in no world
  void addTo(btDynamicsWorld& world);
  void leaveWorld();

  const RobotModel& model() const { return model_; }
  /// By name. @throws std::runtime_error with the known names.
  btRigidBody& body(const std::string& link) const;
  btTypedConstraint& joint(const std::string& joint) const;
  const LinkShape& shape(const std::string& link) const;
  const RigidPose& linkInBody(const std::string& link) const;

  /// Position of a revolute [rad] or prismatic [m] joint. @throws as joint()
  double position(const std::string& joint) const;
  /// Drives such a joint with a velocity [rad/s or m/s] and at most an effort [N m or N]; 0: no
  /// longer. `time_step`: of the world [s].
  void setVelocity(const std::string& joint, double velocity, double effort, double time_step);

 private:
  std::size_t linkIndex(const std::string& link) const {
    return static_cast<std::size_t>(model_.linkIndex(link));
  }
  std::size_t jointIndex(const std::string& joint) const {
    return static_cast<std::size_t>(model_.jointIndex(joint));
  }
  void makeBody(std::size_t index, const RigidPose& pose, const RobotSettings& settings);
  std::unique_ptr<btTypedConstraint> makeJoint(std::size_t index) const;

  RobotModel model_;
  std::vector<LinkMassFrame> frames_;
  std::vector<LinkShape> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;  // that of the root is null
  btDynamicsWorld* world_ = nullptr;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
