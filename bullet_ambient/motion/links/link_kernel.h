#pragma once

#include "bullet_ambient/base/instruction_set.h"

namespace ambient {

// Plain data of LinkDynamics for link_kernel.cpp, which is compiled once per instruction set and
// must not include Eigen. No struct has functions: these would be shared with the other kernels.

/// Three components along the axes of a frame. The fourth lane is 0. A struct, because without AVX
/// a compiler has no agreed way to pass the vector itself. Its alignment is that of machines with
/// AVX on all: gcc would take 16 bytes without.
struct alignas(32) AxisRow {
  double __attribute__((vector_size(32))) at;
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

/// What a kick of h [s] has besides the inertias of the links, docs/theory.md eq. (81) and (123).
struct KickTerms {
  const double* drags;              ///< drag_l >= 0 of each link [1]
  const InertiaBlocks* resistance;  ///< C_l of each link; null: all zero
  double h;
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

  // Set by LinkKernel::computePoses().
  AxisMatrix rotation_W, rotation_W_transposed;  ///< link to W, and back
  AxisRow position_W;                            ///< centre of mass [m]
  AxisRow flow;                                  ///< ambient velocity [m/s]
  AxisPair external;  ///< applied wrench, buoyancy, and K times the flow's acceleration

  // Set by the velocity.
  AxisPair twist;         ///< V
  AxisPair acceleration;  ///< A for the given du/dt; after accelerate(): J_l du/dt of its result
  AxisPair force;         ///< f of the link; after sumForces(), sumNeeds(): sum over its subtree
  double energy = 0;      ///< twice the kinetic energy relative to the flow [J]

  // Set by the factorisation of H.
  InertiaBlocks articulated;  ///< I^A of eq. (79)
  AxisPair axis_momentum[3];  ///< I^A S
  double inverse[3][3];       ///< (S^T I^A S)^-1
  double weight[3];           ///< diagonal of S^T I^A S
  double rest[3];             ///< joint forces; sumNeeds() subtracts those of the subtree
};

/// Settings of a btMultiBody for all its links.
struct MultiBodySettings {
  double linear_damping = 0;        ///< d in Bullet's force -d (1 + |v|) m v, with v in m/s
  double angular_damping = 0;       ///< d in Bullet's torque -d (1 + |w|) J w, with w in rad/s
  bool has_gyroscopic_term = true;  ///< false: w x J w of the dry inertia is left out
};

/// Recursions of LinkDynamics over the links of one tree, docs/theory.md eq. (76) to (79), for one
/// instruction set. `links`: base first. `u` and results are coordinates of the tree. No operation
/// is fused, so that all instruction sets give the same bits. Letters V, A, f, K are members of
/// LinkState.
struct LinkKernel {
  /// Sets the members that LinkState lists under computePoses(), from models and offsets.
  void (*computePoses)(LinkState* links, int count) noexcept;
  /// Sets V for the velocity `u`.
  void (*setVelocity)(LinkState* links, int count, const double* u) noexcept;
  /// Sets V, A and f of eq. (77) for the velocity `u` and the given du/dt; null: zero.
  void (*computeForces)(LinkState* links, int count, const MultiBodySettings& settings,
                        const double* u, const double* acceleration) noexcept;
  /// Sets f to the wrench of surroundings, buoyancy and damping on each link, F_l + D_l of eq.
  /// (77), plus K times the flow's acceleration.
  void (*computeApplied)(LinkState* links, int count, const MultiBodySettings& settings) noexcept;
  /// Sets f to K V.
  void (*computeMomenta)(LinkState* links, int count) noexcept;
  /// Sets f to K V_r and `energy` to V_r.K V_r.
  void (*measure)(LinkState* links, int count) noexcept;
  /// Returns the sum of V.K V.
  double (*norm)(const LinkState* links, int count) noexcept;
  /// Adds f of each link to its parent's, and writes the generalized forces sum J_l^T f_l.
  void (*sumForces)(LinkState* links, int count, double* force) noexcept;
  /// Takes the joints out of the sum of J_l^T ((1 + drag_l) K_l + h C_l) J_l, eq. (79), (123);
  /// `kick` null: of J_l^T K_l J_l. What is left is LinkState::articulated of the base. Returns
  /// false if the part of a joint is not positive definite.
  bool (*articulate)(LinkState* links, int count, const KickTerms* kick) noexcept;
  /// Sets LinkState::articulated of the base to the inertia of the tree with its joints held.
  /// Overwrites that of the other links, and keeps all else that articulate() has set.
  void (*lockJoints)(LinkState* links, int count) noexcept;
  /// First half of the solution of H du/dt = sum S^T rest - sum J_l^T f_l, towards the base. Sets f
  /// of the base to the wrench that its acceleration needs. Overwrites all f and `rest`.
  void (*sumNeeds)(LinkState* links, int count) noexcept;
  /// Second half: writes du/dt for LinkState::acceleration of the base.
  void (*accelerate)(LinkState* links, int count, double* result) noexcept;
};

extern const LinkKernel kLinkKernelBaseline, kLinkKernelAvx2, kLinkKernelAvx512;

extern const Kernels<const LinkKernel*> kLinkKernels;

}  // namespace ambient
