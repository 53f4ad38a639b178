#pragma once

#include <array>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/resistance.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

struct FormShape;

/// Density [kg/m^3] and viscosity [Pa s] of a fluid, and the height of the roughness of a surface
/// in it [m].
struct ViscousFluid {
  double density = 0, viscosity = 0, roughness = 0;
};

/// State of the boundary layers on a body, docs/theory.md eq. (104) and (105).
struct LayerState {
  double turbulent = 0;  ///< T_1: 0 laminar up to where it leaves, 1 turbulent before it leaves
  double from_nose = 0;  ///< T_2: 0 turbulent from a bubble on, 1 from the nose
  double roughness = 1;  ///< r: friction of a turbulent layer over that on a smooth surface
  double growth = 0;  ///< min(sqrt(r) - 1, 1.5): between the smooth and the rough wake of k_1, k_4
  double onset = 0;   ///< X of eq. (104), 1 in the middle of the crisis

  /// Blends values of the four states: laminar, bubble, smooth and rough.
  double blend(double laminar, double bubble, double smooth, double rough, double most) const;
};

/// Computes the state. `thickness`: N; Re on D_A; relative_roughness: k/D_A.
LayerState layerState(double thickness, double reynolds, double relative_roughness) noexcept;

/// What scales the loads on a body in one motion, docs/theory.md eq. (102) to (112), and the loads
/// of section 19 that are no sum over faces. About O, the centre of volume, in the axes of F.
class ViscousLaw {
 public:
  /// own_drag: C_j^0, coefficients of the form law along q_j, mean of both ways.
  ViscousLaw(const FluidBody& body, const FormShape& shape, const Vector3& own_drag,
             const ViscousFluid& fluid);

  /// Axes q_j of all scalars, in columns.
  const Matrix3& axes() const { return axes_; }
  const Resistance& resistance() const { return resistance_; }
  /// True if some of the base separates from a smooth surface; else S = 1 in every motion.
  bool isSmooth() const { return is_smooth_; }

  struct Scalars {
    bool moves = false;   ///< false: no load
    double speed = 0;     ///< U [m/s]
    double reynolds = 0;  ///< on D_A and U
    LayerState layers;
    Vector3 along_sq{0, 0, 0};           ///< E_j, sum 1
    Vector3 ahead{0, 0, 0};              ///< p_+j: share of the numbers of the way +q_j
    Vector3 turning{1, 1, 1};            ///< of S, about q_j
    Vector3 moving{1, 1, 1};             ///< s_j of S, along q_j
    double pressure = 1;                 ///< c
    double smooth = 0;                   ///< chi, share of the smooth base
    double layer_area = 0;               ///< X of eq. (114) [m^2]
    double sharp_growth = 0;             ///< g
    double h_turning = 0, h_moving = 0;  ///< h_r, h_t
    double l_turning = 1, l_moving = 1;  ///< l_r, and l_t but for its factor of b
  };
  /// Computes the scalars of a motion: w, and v at F's origin, relative to the fluid, in F.
  Scalars scalars(const Twist& x) const noexcept;
  /// Lambda of eq. (113); `power`: -F_P.x of the pressure [W], eq. (111).
  Growth growth(const Scalars& s, double power) const noexcept;
  /// Friction of the smooth share's layer, eq. (114), about O for the velocity there.
  Vector3 layerForce(const Scalars& s, const Vector3& v) const noexcept;
  /// c times the lift of the tail, eq. (115), and its drag. About O, for the motion there.
  Wrench tailLoad(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept;
  /// What eq. (116) and (117) add to the lift of the rotation (47) at O: less lift, more drag.
  Vector3 spinForce(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept;
  /// Factor of eq. (118) on the loss of Munk's moment.
  double munkShare(const Scalars& s) const { return s.pressure * s.along_sq.dot(s.moving); }

 private:
  /// Numbers of one way along an axis that a step needs.
  struct Way {
    double thickness_sq, bubble_friction, nose_friction;
    double layer;                           ///< x of eq. (107)
    double laminar, bubble, smooth, rough;  ///< sigma of eq. (106)
  };
  void setWays(const FluidBody& body, const Vector3& own_drag);
  void setTail(const FluidBody& body, const FormShape& shape, const Vector3& masses);
  void addLayers(Scalars& s) const noexcept;
  double wayBlend(const Scalars& s, int axis, double Way::*number) const noexcept;

  ViscousFluid fluid_;
  Matrix3 axes_;
  Vector3 centre_;
  Resistance resistance_;
  Matrix3 gyration_, drag_matrix_;  ///< G, R_vv
  double diameter_, area_, half_volume_, sharp_share_, drag_trace_;
  Vector3 frontal_, moments_;
  Vector3 share_{0, 0, 0};   ///< chi_j
  Vector3 uneven_{0, 0, 0};  ///< nu_i
  bool is_smooth_ = false;
  std::array<Way, 6> ways_{};
  double tail_ = 0, tail_place_ = 0;                  ///< C_t0, x_t [m]
  std::array<std::array<double, 4>, 2> tail_ways_{};  ///< k_L, k_B, k_1, k_4 of +-q_1
};

/// Loads on a smooth ball, docs/theory.md eq. (119), about its centre for the motion there.
struct BallLoad {
  Wrench pressure;     ///< with the lift of the spin
  Wrench layer;        ///< friction of turbulent layers
  Growth growth;       ///< of ballResistance()
  double suction = 1;  ///< s: factor on the motion and on the load of the pressure on a part of it
  double share = 1;    ///< c
  Vector3 whole{0, 0,
                0};  ///< part of `pressure` that is no pressure on faces: lift, and drag by it
};
BallLoad computeBallLoad(double radius, const ViscousFluid& fluid, const Twist& x) noexcept;
/// 8 pi mu R^3, 6 pi mu R, about the centre.
Resistance ballResistance(double radius, double viscosity) noexcept;

}  // namespace ambient
