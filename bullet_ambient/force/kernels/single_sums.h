#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/fluid_body/blocks.h"
#include "bullet_ambient/force/law/face_pressure.h"
#include "bullet_ambient/force/law/pressure_law.h"

namespace ambient {

// Sums over faces in single precision. Plain data only: the kernels are compiled once per
// instruction set, and must not share an inline function with the rest of the program.

/// Water surface as a plane in F, for the wet shares of docs/theory.md eq. (59), in the unit of
/// length of the faces.
struct SingleCut {
  float normal[3];  ///< out of the fluid
  float height;     ///< height of the plane above F's origin along the normal
  float disc;       ///< 1/pi in these units: squared radius of a disc over its area
};

/// Motion of the body relative to the ambient flow, in F, separation angle and skin friction, in
/// units of length and speed in which all components are at most 1.
struct SingleMotion {
  float angular[3];
  float linear[3];
  float signed_cosine_sq;          ///< -cos(alpha) |cos(alpha)|; 0 at a right angle
  float sine_sq;                   ///< sin^2(alpha)
  float friction;                  ///< C_f of eq. (16) at unit slip speed; 0: no friction
  const SingleCut* cut = nullptr;  ///< null: all faces are in the fluid
  PressureLaw law = PressureLaw::kPublished;
  const WingFactors<float>* wing = nullptr;  ///< for the form law; null: neither wing nor slender
  float pitching_rate = 0;                   ///< a.w of eq. (43d)
  /// Twist without a part of the pitching, in which the normal velocity of a face is nu, eq. (43d).
  float pitched_angular[3] = {}, pitched_linear[3] = {};
  float stalling_share = 1;  ///< 1 - chi of eq. (161), of a part of a body
};

/// Sums over attached faces in the units of SingleMotion, without the factor -rho/2. `wrench`:
/// |t|^2 A (c x n, n) + friction |t|^0.8 A (c x t, t), torque first; with the form law, q + q_L
/// replaces |t|^2. `pitch`: q_L A mu of wings, eq. (43d).
struct LoadSums {
  double wrench[6];
  double pitch = 0;
};

/// Sums all blocks. Skips blocks without load: bounds show that the flow is detached from all their
/// faces. Face i of a block goes to lane i. Runs of 16 blocks are summed in single precision, and
/// runs are added in double. Fused products are explicit, and emulated on processors without them,
/// so that all instruction sets give the same bits.
using SumBlocks = LoadSums (*)(const FaceBlocks&, const SingleMotion&) noexcept;

LoadSums sumBlocksBaseline(const FaceBlocks&, const SingleMotion&) noexcept;
LoadSums sumBlocksAvx2(const FaceBlocks&, const SingleMotion&) noexcept;
LoadSums sumBlocksAvx512(const FaceBlocks&, const SingleMotion&) noexcept;
extern const Kernels<SumBlocks> kSumBlocks;

}  // namespace ambient
