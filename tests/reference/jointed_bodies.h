#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace ambient::reference {

// Bodies in a fluid with joints in maximal coordinates: six velocities per body in world axes, each
// joint as constraints. One dense system in extended precision gives all accelerations, or velocity
// changes, and all reactions.

using JointedReal = long double;
using JointedVector3 = Eigen::Matrix<JointedReal, 3, 1>;
using JointedVector6 = Eigen::Matrix<JointedReal, 6, 1>;  ///< rotation first
using JointedVector = Eigen::Matrix<JointedReal, Eigen::Dynamic, 1>;
using JointedMatrix3 = Eigen::Matrix<JointedReal, 3, 3>;
using JointedMatrix6 = Eigen::Matrix<JointedReal, 6, 6>;
using JointedMatrix = Eigen::Matrix<JointedReal, Eigen::Dynamic, Eigen::Dynamic>;

enum class JointedKind { kRevolute, kPrismatic, kSpherical, kPlanar, kFixed };

/// A body and the joint to its parent; the joint of the base, the first body, is unused.
struct JointedBody {
  // Quantities in the body's frame, origin at the centre of mass.
  JointedReal mass = 1;
  JointedVector3 moments = JointedVector3::Ones();
  JointedMatrix6 added_mass = JointedMatrix6::Zero();  ///< times density
  JointedReal displaced_mass = 0;
  JointedVector3 centre_of_volume = JointedVector3::Zero();

  // Quantities in world axes.
  JointedVector3 flow = JointedVector3::Zero(), flow_acceleration = JointedVector3::Zero();
  JointedVector3 gravity = JointedVector3::Zero();  ///< for buoyancy alone
  JointedVector6 applied = JointedVector6::Zero();  ///< torque, force at the centre of mass

  // Joint to the parent.
  int parent = -1;
  JointedKind kind = JointedKind::kFixed;
  JointedMatrix3 zero_rotation = JointedMatrix3::Identity();  ///< from the parent's axes
  JointedVector3 parent_to_pivot = JointedVector3::Zero();    ///< in the parent's axes
  JointedVector3 pivot_to_body = JointedVector3::Zero();      ///< in the body's axes
  std::array<JointedVector3, 3> axes;     ///< planar: normal, two directions; else axes[0]
  std::array<JointedReal, 4> position{};  ///< as in Bullet; spherical: x, y, z, w
  std::array<JointedReal, 3> velocity{}, force{};

  // Pose and velocity in the world; input for the base, output of placeBodies() for the others.
  JointedMatrix3 rotation = JointedMatrix3::Identity();  ///< body to world
  JointedVector3 origin = JointedVector3::Zero();
  JointedVector3 w = JointedVector3::Zero(), v = JointedVector3::Zero();
};

/// Sets poses and velocities of all bodies from the base and the joint positions and rates.
void placeBodies(std::vector<JointedBody>& bodies);

/// Accelerations in joint coordinates: base (angular, linear, world axes), then the joint
/// velocities of all bodies. `fixed`: the base keeps its twist in its own axes; a base of zero
/// twist stays at rest.
JointedVector jointedAccelerations(const std::vector<JointedBody>& bodies, bool fixed);

/// Velocity changes by impulses, in joint coordinates. J: a row per impulse, six columns per body.
JointedVector jointedResponse(const std::vector<JointedBody>& bodies, bool fixed,
                              const JointedVector& impulse_of_bodies);

}  // namespace ambient::reference
