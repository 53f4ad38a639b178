#pragma once

namespace ambient {

// Plain data of LinkDynamics for link_kernel.cpp, which is compiled once per instruction set and
// must not include Eigen.

/// Three components along the axes of a frame. The fourth number is 0 and fills the register.
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

/// State of one link. Vectors are in the link's frame unless their names end in _W.
struct LinkState {
  int parent = -1;
  int first = 0;  ///< index in u of the first velocity of its joint
  int axis_count = 0;
  AxisPair axis[3];  ///< S

  // Set by LinkDynamics::setPose() and moveTo().
  bool is_kept = false;  ///< true: velocities of the link and all its ancestors are prescribed
  bool accelerates_flow = false;  ///< true: its flow accelerates
  double mass = 0;                ///< dry mass [kg]
  AxisRow moments;                ///< dry principal moments of inertia [kg m^2]
  InertiaBlocks inertia;          ///< K
  AxisMatrix coupling_transposed;
  AxisRow flow_W, flow_acceleration_W;
  AxisPair applied_W;        ///< applied torque and force, and -m a of the flow's acceleration a
  AxisRow buoyancy_W;        ///< force at the centre of volume
  AxisRow centre_of_volume;  ///< [m]
  /// Rotation from the link to its parent; of the base: to W.
  AxisMatrix offset, offset_transposed;
  AxisRow translation;  ///< centre of mass in the parent's frame; of the base: in W [m]

  // Set by LinkKernel::place().
  AxisMatrix rotation_W, rotation_W_transposed;  ///< link to W, and back
  AxisRow position_W;                            ///< centre of mass [m]
  AxisRow flow;                                  ///< ambient velocity [m/s]
  AxisPair external;  ///< applied wrench, buoyancy, and K times the flow's acceleration

  // Set by the velocity.
  AxisPair twist;         ///< V
  AxisPair acceleration;  ///< A for the given du/dt; after solve(): J_l du/dt of its result
  AxisPair force;         ///< f of the link; after sumForces(), solve(): sum over its subtree
  double energy = 0;      ///< twice the kinetic energy relative to the flow [J]

  // Set by the factorisation of H.
  InertiaBlocks articulated;  ///< I^A of eq. (79)
  AxisPair push[3];           ///< I^A S
  double inverse[3][3];       ///< (S^T I^A S)^-1
  double weight[3];           ///< diagonal of S^T I^A S
  double rest[3];             ///< joint forces; solve() subtracts those that the subtree needs
};

/// Factors L D L^T of a symmetric positive definite 6x6 matrix.
struct BaseFactor {
  double lower[6][6];   ///< L below its diagonal of ones
  double per_pivot[6];  ///< D^-1
  bool is_positive = false;
};

/// Settings of a btMultiBody for all its links: damping of the dry mass, and gyroscopic term w x J
/// w of the dry inertia.
struct TreeHabits {
  double linear_damping = 0, angular_damping = 0;
  bool has_gyroscopic_term = true;
};

}  // namespace ambient
