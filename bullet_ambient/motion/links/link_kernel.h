#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/links/link_state.h"

namespace ambient {

/// Recursions of LinkDynamics over the links of one tree, docs/theory.md eq. (76) to (79), base
/// first, for one instruction set. No operation is fused: the same bits with all of them. `u` and
/// results are coordinates of the tree.
struct LinkKernel {
  /// Sets what follows from models and offsets.
  void (*place)(LinkState* links, int count) noexcept;
  /// Sets V.
  void (*setVelocity)(LinkState* links, int count, const double* u) noexcept;
  /// Sets V, A and f with the given du/dt; null for none.
  void (*computeForces)(LinkState* links, int count, const TreeHabits& habits, const double* u,
                        const double* acceleration) noexcept;
  /// Sets f to what acts on each link, with the opposite sign of its part in computeForces().
  void (*computeApplied)(LinkState* links, int count, const TreeHabits& habits) noexcept;
  /// Sets f to K V.
  void (*computeMomenta)(LinkState* links, int count) noexcept;
  /// Sets f to K V_r and `energy` to V_r.K V_r.
  void (*measure)(LinkState* links, int count) noexcept;
  /// Returns the sum of V.K V.
  double (*norm)(const LinkState* links, int count) noexcept;
  /// Sums f over subtrees, and writes what it is along the coordinates.
  void (*sumForces)(LinkState* links, int count, double* force) noexcept;
  /// Factors the sum of (1 + drag_l) J_l^T K_l J_l; `drag` null: of J_l^T K_l J_l. False if it is
  /// not positive definite.
  bool (*articulate)(LinkState* links, int count, const double* drag, BaseFactor& base) noexcept;
  /// Factors the inertia of the tree with its joints held. The factor of articulate() stays.
  void (*holdJoints)(LinkState* links, int count, BaseFactor& held) noexcept;
  /// Writes the accelerations of links at rest that need `force` and whose joints get `rest`.
  void (*solve)(LinkState* links, int count, const BaseFactor& base, double* result) noexcept;
  /// Replaces b, in the base's frame, by what a factor answers to it.
  void (*answer)(const BaseFactor& factor, double* b) noexcept;
};

extern const LinkKernel kLinkKernelBaseline, kLinkKernelAvx2, kLinkKernelAvx512;

constexpr Kernels<const LinkKernel*> kLinkKernels{&kLinkKernelBaseline, &kLinkKernelAvx2,
                                                  &kLinkKernelAvx512};

}  // namespace ambient
