#pragma once

#include <vector>

#include "tests/bullet_ambient/bullet/robots/link_reference.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

namespace ambient::test {

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
