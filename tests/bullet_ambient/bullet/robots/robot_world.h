#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/fluid.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/random_bodies.h"

namespace ambient::test {

/// Which joints the links of an arbitrary robot have.
enum class Joints {
  kRevolute,  ///< in one chain
  kSmooth,    ///< revolute, prismatic, spherical and fixed ones in turn, in a tree
  kAll,       ///< planar ones too
};

struct RobotDef {
  int links = 3;
  Joints joints = Joints::kRevolute;
  bool has_fixed_base = false;
  double speed = 1;            ///< joints at up to twice this [rad/s, m/s]
  double collider_radius = 0;  ///< a sphere at each centre of mass; 0: none has a collider
};

/// A multibody world with a fluid, gravity 0, without position correction, softness and damping.
class RobotWorld {
 public:
  explicit RobotWorld(std::unique_ptr<btMultiBodyConstraintSolver> stock = nullptr);
  ~RobotWorld();

  /// Links of 0.3 kg to 1.3 kg, 0.3 m apart, at an arbitrary pose and motion, in the world.
  btMultiBody& add(Arbitrary& arbitrary, const RobotDef& def);
  void take(std::unique_ptr<btMultiBodyConstraint> constraint);
  void remove(btMultiBody& body);
  btCollisionObject& addFixed(std::unique_ptr<btCollisionShape> shape, const btTransform& place);
  /// Contact and joint places as they are at the start of a step.
  static void moveColliders(btMultiBody& body);
  void step(double duration, int count = 1);

  Fluid<btMultiBodyConstraintSolver> fluid;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  std::unique_ptr<btMultiBodyConstraintSolver> stock_solver;  ///< in place of the fluid's
  btMultiBodyDynamicsWorld world;

 private:
  void addCollider(btMultiBody& body, int link, double radius);

  std::vector<std::unique_ptr<btMultiBody>> robots_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

/// A fluid of density 1 around a link, of arbitrary coupled added mass, `ratio` times its mass.
AttachDef coupledFluid(Arbitrary& arbitrary, const btMultiBody& body, int link, double ratio);

/// Puts all links of a robot, its base among them, into coupledFluid() of their own. A fixed base
/// has none.
void putIntoFluid(Arbitrary& arbitrary, RobotWorld& world, btMultiBody& body, double ratio);

Eigen::VectorXd velocityOf(const btMultiBody& body);
/// |a - b| / |b|
double relativeError(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

}  // namespace ambient::test
