#pragma once

#include "bullet_ambient/force/law/pressure_law.h"
#include "bullet_ambient/force/law/wing_pressure.h"

namespace ambient {

// Input and output of sums in single precision. Plain data only, as in face_sums.h.

/// FaceCut in the unit of length of the faces.
struct SingleCut {
  float normal[3];
  float height;
  float disc;  ///< squared radius of a disc whose area is one unit of area
};

/// FaceMotion with the skin friction, in units of length and speed that make all components at
/// most 1.
struct SingleMotion {
  float angular[3];
  float linear[3];
  float signed_cosine_sq;
  float sine_sq;
  float friction;                  ///< C_f of a face that slips with the unit of speed; 0: none
  const SingleCut* cut = nullptr;  ///< null: all is in the fluid
  PressureLaw law = PressureLaw::kPublished;
  const WingFactors<float>* wing = nullptr;  ///< for the form law; null: neither wing nor slender
  float pitching_rate = 0;                   ///< a.w of eq. (43d)
  float pitched_angular[3] = {}, pitched_linear[3] = {};  ///< twist of the lift, eq. (43d)
  float slip_share = 0;                                   ///< tau of eq. (43e)
};

/// Sum of |t|^2 A (c x n, n) + friction |t|^0.8 A (c x t, t) over attached faces, torque first.
/// `pitch`: sum of q_L A mu over wings, eq. (43d).
struct LoadSums {
  double wrench[6];
  double pitch = 0;
};

}  // namespace ambient
