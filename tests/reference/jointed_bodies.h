#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace ambient::reference {

// Bodies in a fluid with joints, in maximal coordinates: six velocities for each body, in world
// axes, and every joint as constraints. All accelerations, or changes of velocity, and all
// reactions at once are the solution of one dense system, in extended precision.

using JointedReal = long double;
using JointedVector3 = Eigen::Matrix<JointedReal, 3, 1>;
using JointedVector6 = Eigen::Matrix<JointedReal, 6, 1>;  ///< rotation first
using JointedVector = Eigen::Matrix<JointedReal, Eigen::Dynamic, 1>;
using JointedMatrix3 = Eigen::Matrix<JointedReal, 3, 3>;
using JointedMatrix6 = Eigen::Matrix<JointedReal, 6, 6>;
using JointedMatrix = Eigen::Matrix<JointedReal, Eigen::Dynamic, Eigen::Dynamic>;

enum class JointedKind { kFixed, kRevolute, kPrismatic, kSpherical, kPlanar };

/// A body and the joint on which it hangs; the joint of the first one, the base, is unused.
struct JointedBody {
  // In the body's frame, origin at the centre of mass.
  JointedReal mass = 1;
  JointedVector3 moments = JointedVector3::Ones();
  JointedMatrix6 added_mass = JointedMatrix6::Zero();  ///< times density
  JointedReal displaced_mass = 0;
  JointedVector3 centre_of_volume = JointedVector3::Zero();

  // In the world.
  JointedVector3 flow = JointedVector3::Zero(), flow_acceleration = JointedVector3::Zero();
  JointedVector3 gravity = JointedVector3::Zero();  ///< for buoyancy alone
  JointedVector6 applied = JointedVector6::Zero();  ///< torque, force at the centre of mass

  // The joint.
  int parent = -1;
  JointedKind kind = JointedKind::kFixed;
  JointedMatrix3 zero_rotation = JointedMatrix3::Identity();  ///< from the parent's axes
  JointedVector3 parent_to_pivot = JointedVector3::Zero();    ///< in the parent's axes
  JointedVector3 pivot_to_body = JointedVector3::Zero();      ///< in the body's axes
  std::array<JointedVector3, 3> axes;     ///< revolute, prismatic: one; planar: normal and two ways
  std::array<JointedReal, 4> position{};  ///< as Bullet has it; spherical: x, y, z, w
  std::array<JointedReal, 3> velocity{}, force{};

  // Pose and velocity in the world; given for the base, computed by placeBodies() for the others.
  JointedMatrix3 rotation = JointedMatrix3::Identity();  ///< body to world
  JointedVector3 origin = JointedVector3::Zero();
  JointedVector3 w = JointedVector3::Zero(), v = JointedVector3::Zero();
};

/// Poses and velocities of all bodies from those of the base, and of the joints.
void placeBodies(std::vector<JointedBody>& bodies);

/// Momentum of all bodies and the fluid that they carry, in world axes about the world's origin:
/// angular, linear. The fluid is at rest.
JointedVector6 totalMomentum(const std::vector<JointedBody>& bodies);

/// Accelerations as a tree counts them: of the base (angular, linear, world axes), then of the
/// velocities of all joints. `fixed`: the base keeps its twist in its own axes, and is at rest if
/// that is zero.
JointedVector jointedAccelerations(const std::vector<JointedBody>& bodies, bool fixed);

/// The same for changes of velocity by impulses: J has one row per impulse, six columns per body.
JointedVector jointedResponse(const std::vector<JointedBody>& bodies, bool fixed,
                              const JointedVector& impulse_of_bodies);

}  // namespace ambient::reference
