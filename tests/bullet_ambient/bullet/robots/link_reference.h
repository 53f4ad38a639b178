#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <vector>

#include "bullet_ambient/fluid.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/reference/dense_rows.h"

namespace ambient::test {

using reference::DenseVector6;
using reference::Real;

/// Step [s] so short that forces and turns vanish, but longer than Bullet's zero. In double the
/// error is proportional to the step: contacts 2.5e-12 at 1e-13, 2.5e-14 at 1e-15.
constexpr double kMoment = byPrecision(1e-15, 2e-7);
/// Tolerance of twistError().
constexpr double kRowTolerance = byPrecision(1e-12, 1e-5);

/// A robot in maximal coordinates. Body 0 is the base, body l + 1 is link l, the last body is the
/// ground. Joints are rows at their pivots and about their axes; no recursion.
struct DenseRobot {
  std::vector<reference::DenseBody> bodies;
  std::vector<reference::DenseRow> rows;

  int ground() const { return static_cast<int>(bodies.size()) - 1; }
};

/// Copies the robot with its present pose and motion; links in fluid with the inertia that the
/// fluid reports.
/// @pre its colliders and cached transforms are those of now
DenseRobot denseRobot(const btMultiBody& body, const Fluid& fluid);

/// Twists of base and links at their centres of mass, world axes.
std::vector<DenseVector6> twistsOf(const btMultiBody& body);

/// Row of the velocity of a link's point along a direction, relative to the ground.
reference::DenseRow groundRow(const btMultiBody& body, int link, const btVector3& point,
                              const btVector3& direction);

/// Row of the rate of a revolute or prismatic joint.
reference::DenseRow rateRow(const btMultiBody& body, int link);

/// Row of a link's spin relative to its parent about an axis of the link, 0 to 2.
reference::DenseRow turnRow(const btMultiBody& body, int link, int axis);

/// Makes the base kinematic: fixes its twist.
void driveBase(const btMultiBody& body, DenseRobot& robot);

/// Largest twist error of all links over the fastest before or after; angular parts times 0.15 m.
double twistError(const btMultiBody& now, const std::vector<DenseVector6>& expected,
                  const std::vector<DenseVector6>& before);

/// Radius of the spheres that touch floors.
constexpr double kSphereRadius = 0.05;

/// A box whose face a link's sphere touches, with its normal along `normal`.
btCollisionObject& addFloor(RobotWorld& world, const btMultiBody& body, int link,
                            const btVector3& normal, double restitution);

/// Properties common to the points of all contacts.
struct ContactLaw {
  double restitution = 0;
  double friction = 0;
  int friction_directions = 0;  ///< 0 to 2 rows of friction for each point
};

/// Adds rows for the contact points of the last step, which began with the twists `before`.
void addContacts(RobotWorld& world, const btMultiBody& body,
                 const std::vector<DenseVector6>& before, const ContactLaw& law, DenseRobot& robot);

}  // namespace ambient::test
