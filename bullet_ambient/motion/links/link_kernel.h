#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/links/link_state.h"

namespace ambient {

/// Recursions of LinkDynamics over the links of one tree, docs/theory.md eq. (76) to (79), for one
/// instruction set. `links`: base first. `u` and results are coordinates of the tree. No operation
/// is fused, so that all instruction sets give the same bits. Letters V, A, f, K are members of
/// LinkState.
struct LinkKernel {
  /// Sets the members that LinkState lists under place(), from models and offsets.
  void (*place)(LinkState* links, int count) noexcept;
  /// Sets V for the velocity `u`.
  void (*setVelocity)(LinkState* links, int count, const double* u) noexcept;
  /// Sets V, A and f of eq. (77) for the velocity `u` and the given du/dt; null: zero.
  void (*computeForces)(LinkState* links, int count, const TreeHabits& habits, const double* u,
                        const double* acceleration) noexcept;
  /// Sets f to the wrench of surroundings, buoyancy and damping on each link, F_l + D_l of eq.
  /// (77), plus K times the flow's acceleration.
  void (*computeApplied)(LinkState* links, int count, const TreeHabits& habits) noexcept;
  /// Sets f to K V.
  void (*computeMomenta)(LinkState* links, int count) noexcept;
  /// Sets f to K V_r and `energy` to V_r.K V_r.
  void (*measure)(LinkState* links, int count) noexcept;
  /// Returns the sum of V.K V.
  double (*norm)(const LinkState* links, int count) noexcept;
  /// Adds f of each link to its parent's, and writes the generalized forces sum J_l^T f_l.
  void (*sumForces)(LinkState* links, int count, double* force) noexcept;
  /// Factors the sum of (1 + drag_l) J_l^T K_l J_l, eq. (79); `drag` null: all zero. Returns false
  /// if it is not positive definite.
  bool (*articulate)(LinkState* links, int count, const double* drag, BaseFactor& base) noexcept;
  /// Factors the inertia of the tree with its joints held. Keeps the factor of articulate(), but
  /// overwrites LinkState::articulated.
  void (*holdJoints)(LinkState* links, int count, BaseFactor& held) noexcept;
  /// Writes the accelerations du/dt for which links need the wrenches f, with the joint forces
  /// `rest`: H du/dt = sum S^T rest - sum J_l^T f_l. Overwrites f and `rest`.
  void (*solve)(LinkState* links, int count, const BaseFactor& base, double* result) noexcept;
  /// Replaces b [6] by the solution of the factored system; in the base's frame.
  void (*answer)(const BaseFactor& factor, double* b) noexcept;
};

extern const LinkKernel kLinkKernelBaseline, kLinkKernelAvx2, kLinkKernelAvx512;

extern const Kernels<const LinkKernel*> kLinkKernels;

}  // namespace ambient
