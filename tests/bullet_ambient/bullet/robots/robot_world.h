#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/fluid.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {

/// Joints of a random robot's links.
enum class Joints {
  kRevolute,  ///< in one chain
  kSmooth,    ///< tree: revolute, prismatic, spherical, fixed in turn
  kAll,       ///< kSmooth's, and planar
};

struct RobotDef {
  int links = 3;
  Joints joints = Joints::kRevolute;
  bool has_fixed_base = false;
  double speed = 1;            ///< joint speeds up to twice this [rad/s, m/s]
  double collider_radius = 0;  ///< sphere at each centre of mass; 0: no colliders
};

/// Makes a robot outside of any world: links of 0.3 kg to 1.3 kg, 0.3 m apart, random pose and
/// motion.
std::unique_ptr<btMultiBody> arbitraryRobot(Arbitrary& arbitrary, const RobotDef& def);

/// A multibody world with a fluid, gravity 0, without position correction, softness and damping.
struct RobotWorld : TreeWorld {
  RobotWorld();
  ~RobotWorld();

  /// Adds an arbitraryRobot() to the world.
  btMultiBody& add(Arbitrary& arbitrary, const RobotDef& def);
  /// Adds a finished robot, with spheres of a radius [m] as colliders of its links; 0: without.
  btMultiBody& take(std::unique_ptr<btMultiBody> robot, double collider_radius);
  /// Adds a finished robot without damping that never sleeps.
  btMultiBody& takeUndamped(std::unique_ptr<btMultiBody> robot, double collider_radius = 0) {
    btMultiBody& tree = take(std::move(robot), collider_radius);
    tree.setCanSleep(false);
    tree.setLinearDamping(0);
    tree.setAngularDamping(0);
    return tree;
  }
  void take(std::unique_ptr<btMultiBodyConstraint> constraint);
  void remove(btMultiBody& body) { contents.remove(body); }
  btCollisionObject& addFixed(std::unique_ptr<btCollisionShape> shape, const btTransform& place);
  /// Updates contact and joint places to the start of a step.
  static void moveColliders(btMultiBody& body);

  Fluid fluid{world};

 private:
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

/// Fluid of density 1 around a link, random coupled added mass of `ratio` times the link's mass.
AttachDef coupledFluid(Arbitrary& arbitrary, const btMultiBody& body, int link, double ratio);

/// Puts all links and a free base of a robot into separate coupledFluid(). A fixed base stays
/// dry.
void putIntoFluid(Arbitrary& arbitrary, RobotWorld& world, btMultiBody& body, double ratio);

/// Joins the last link to the world by a ball joint.
void holdTip(RobotWorld& world, btMultiBody& body);

Eigen::VectorXd velocityOf(const btMultiBody& body);
/// |a - b| / |b|
double relativeError(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// A world for robots in fluid, and what the fluid says of them.
class Robots : public testing::Test {
 protected:
  Robots() {
    world.fluid.setReport([this](const std::string& text) { heard.push_back(text); });
  }
  btMultiBody& add(const RobotDef& def = {}) { return world.add(arbitrary, def); }
  AttachDef fluidOf(const btMultiBody& body, int link) {
    return coupledFluid(arbitrary, body, link, 2);
  }
  std::string refusal(btMultiBody& body, int link, const AttachDef& def) {
    return refusalOf<std::invalid_argument>([&] { world.fluid.add(body, link, def); });
  }

  std::vector<std::string> heard;
  Arbitrary arbitrary{5};
  RobotWorld world;
};

}  // namespace ambient::test
