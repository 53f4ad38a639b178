#pragma once

namespace ambient {

// Plain data of LinkDynamics, which link_kernel.cpp computes with: nothing of Eigen.

/// Three numbers along the axes of a frame; the fourth is 0, so that they fit the registers.
struct alignas(32) AxisRow {
  double at[4];
};
struct AxisMatrix {
  AxisRow column[3];
};
/// Twist, acceleration, momentum or wrench: rotation first.
struct AxisPair {
  AxisRow angular, linear;
};
/// Symmetric 6x6 inertia by its blocks: (rotation, coupling; coupling^T, translation).
struct InertiaBlocks {
  AxisMatrix rotation, coupling, translation;
};

/// State of one link; in the link's frame where nothing else is said.
struct LinkState {
  int parent = -1;
  int first = 0;  ///< entry of its joint in the coordinates
  int axis_count = 0;
  AxisPair axis[3];  ///< S

  // Set by the pose, with the models.
  bool is_kept = false;           ///< keeps its velocity, and so do all its ancestors
  bool accelerates_flow = false;  ///< its flow is accelerated
  double mass = 0;                ///< without fluid [kg]
  AxisRow moments;                ///< without fluid [kg m^2]
  InertiaBlocks inertia;          ///< K
  AxisMatrix coupling_transposed;
  AxisRow flow_W, flow_acceleration_W;
  AxisPair applied_W;        ///< torque and force of surroundings, less those in buoyancy_W
  AxisRow buoyancy_W;        ///< force at the centre of volume
  AxisRow centre_of_volume;  ///< [m]
  AxisMatrix offset, offset_transposed;  ///< axes of the link in its parent's; of the base in W
  AxisRow translation;                   ///< in the parent's frame; of the base in W [m]

  // Set by LinkKernel::place().
  AxisMatrix rotation_W, rotation_W_transposed;  ///< link to W, and back
  AxisRow position_W;                            ///< of its centre of mass [m]
  AxisRow flow;                                  ///< ambient [m/s]
  AxisPair external;  ///< wrench of surroundings, buoyancy and the flow's acceleration

  // Set by the velocity.
  AxisPair twist;         ///< V
  AxisPair acceleration;  ///< A without the part that is looked for, or that part
  AxisPair force;         ///< f of the link; later of its whole subtree
  double energy = 0;      ///< twice, of its motion relative to the flow [J]

  // Set by the factorisation of H.
  InertiaBlocks articulated;  ///< of the subtree
  AxisPair push[3];           ///< articulated inertia times axes
  double inverse[3][3];       ///< of axes times push
  double weight[3];           ///< diagonal of axes times push
  double rest[3];             ///< joint forces less those that the subtree takes
};

/// Factors of a symmetric positive definite 6x6 matrix, L D L^T.
struct BaseFactor {
  double lower[6][6];   ///< L below its diagonal of ones
  double per_pivot[6];  ///< D^-1
  bool is_positive = false;
};

/// What Bullet does to all links of a tree: its damping of the dry mass, and its switch of w x J w.
struct TreeHabits {
  double linear_damping = 0, angular_damping = 0;
  bool has_gyroscopic_term = true;
};

}  // namespace ambient
