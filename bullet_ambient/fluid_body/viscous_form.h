#pragma once

#include <array>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// What boundary layers make of the flow past a body that moves one way; docs/theory.md eq. (97) to
/// (99). On its frontal area and D_A, without unit. The first four of a state of the layers:
/// laminar; laminar to its separation and turbulent from there (a bubble); turbulent from the nose,
/// smooth and rough (four times the growth).
struct SeparationWay {
  static constexpr std::size_t kNumbers = 8;
  double wake_laminar = 0, wake_bubble = 0, wake_turbulent = 0,
         wake_rough = 0;  ///< k_L, k_B, k_1, k_4
  double thickness =
      0;  ///< N: momentum thickness where the laminar layer leaves, over D_A Re^(-1/2)
  double friction_laminar = 0;    ///< f_L, times Re^(-1/2)
  double friction_bubble = 0;     ///< f_B, times Re^(-1/5)
  double friction_turbulent = 0;  ///< f_T, times Re^(-1/5)
};

/// Where boundary layers leave a shape that moves along an axis of its added mass, either way;
/// docs/theory.md eq. (97) to (100). Without unit: the same for a larger shape.
struct Separation {
  Matrix3 axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< columns q_j, right-handed
  std::array<SeparationWay, 6> ways;              ///< of +q_1, -q_1, +q_2, ...
  Vector3 smooth_base{0, 0, 0};  ///< B_j in [0, 1]: 0 where edges make all of the base
};

/// Sizes of a surface that Reynolds numbers, areas and the twist of separated flow are made of;
/// docs/theory.md eq. (101). Both sides of a sheet count.
struct SurfaceNumbers {
  double diameter = 0;       ///< D_A = sqrt(area/pi): of the ball with this area [m]
  Vector3 frontal{0, 0, 0};  ///< A_j: half of the projected area of all faces along q_j [m^2]
  Vector3 moments{0, 0, 0};  ///< m_j: mean square of the place along q_j [m^2]
  Matrix3 gyration =
      Matrix3::Zero();  ///< G: mean of |r|^2 I - r r^T about the centre of reaction [m^2]
};

/// What a shape needs for a fluid with viscosity, docs/theory.md section 18. Frame F.
struct ViscousForm {
  static constexpr std::size_t kNumbers = 116;
  /// Resistance in creeping flow about F's origin, rotation first, per unit viscosity: as Re -> 0
  /// the wrench is -mu R (w, v). Symmetric, positive semi-definite [m^3, m^2, m]. 0: not known.
  Matrix6 resistance = Matrix6::Zero();
  Vector3 centre_of_reaction{0, 0, 0};  ///< where the coupling of R is symmetric [m]
  Separation separation;  ///< smooth_base is 0 where it is not known: all of the base is by edges
  SurfaceNumbers surface;
  double sharp_share = 1;  ///< eps': how far edges and thin plates fix where the flow leaves
  /// True if `smooth_base` is that of a simple shape, whose rims are no edges in (J1).
  bool is_primitive = false;

  bool isKnown() const { return !resistance.isZero(0); }
  /// All numbers in the order above, matrices by columns, which is that of files.
  std::array<double*, kNumbers> numbers();
  std::array<const double*, kNumbers> numbers() const;
};

}  // namespace ambient
