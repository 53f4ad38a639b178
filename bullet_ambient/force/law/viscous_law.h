#pragma once

#include <array>
#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/surface_load.h"
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

  /// Blends values of the states: laminar, from a bubble on, from the nose on.
  template <class Value>
  Value blend(const Value& laminar, const Value& bubble, const Value& nose) const {
    return (1 - turbulent) * laminar + turbulent * ((1 - from_nose) * bubble + from_nose * nose);
  }
  /// Blends values of the nose's state on a smooth and on a rough surface.
  template <class Value>
  Value atNose(const Value& smooth, const Value& rough) const {
    return smooth + growth * (rough - smooth);
  }
};

/// Computes the state. `thickness`: N; Re on D_A; relative_roughness: k/D_A.
LayerState layerState(double thickness, double reynolds, double relative_roughness) noexcept;

/// Largest Reynolds number that the law reads; beyond it loads are those at this one.
constexpr double kMostReynolds = 1e60;  // keeps powers finite

/// Returns chi_j of eq. (107) along the axes q_j: share of the base whose wake the layers shrink;
/// 0: the drag falls nowhere.
Vector3 smoothShares(const FluidBody& body, const FormShape& shape);

/// What scales the loads on a body in one motion, docs/theory.md eq. (102) to (112), and the loads
/// of section 19 that are no sum over faces. About O, the centre of volume, in the axes of F.
class ViscousLaw {
 public:
  /// own_drag: C_j^0, coefficients of the form law along q_j, mean of both ways.
  ViscousLaw(const FluidBody& body, const FormShape& shape, const Vector3& own_drag,
             const ViscousFluid& fluid);

  /// Returns the matrix that scales by s_j along the axes q_j. @pre isSmooth()
  Matrix3 scaling(const Vector3& s) const {
    const Matrix3(&p)[3] = smooth_->projections;
    return s[0] * p[0] + s[1] * p[1] + s[2] * p[2];
  }
  const Resistance& resistance() const { return resistance_; }
  /// True if some of the base separates from a smooth surface; else S = 1 in every motion.
  bool isSmooth() const { return smooth_ != nullptr; }

  struct Scalars {
    bool moves = false;  ///< false: no load
    double speed = 0;    ///< U [m/s]
    LayerState layers;
    double ahead = 0;          ///< p_+1: share of the numbers of the way +q_1
    Vector3 turning{1, 1, 1};  ///< of S, about q_j
    Vector3 moving{1, 1, 1};   ///< s_j of S, along q_j
    double pressure = 1;       ///< c
    double munk = 1;           ///< factor of eq. (118) on the loss of Munk's moment
    double smooth = 0;         ///< chi, share of the smooth base
    double layer_area = 0;     ///< Re^(-1/5) times the sum in eq. (114) [m^2]
    double sharp_growth = 0;   ///< g
    double of_turning = 0;     ///< l_r h_r
    double of_moving = 0;      ///< l_t h_t, but for the factor of b in l_t
  };
  /// Computes the scalars of a motion: w, and v at F's origin, relative to the fluid, in F.
  Scalars scalars(const Twist& x) const noexcept;
  /// Lambda of eq. (113); `power`: -F_P.x of the pressure [W], eq. (111).
  Growth growth(const Scalars& s, double power) const noexcept;
  /// Returns the wrench about O, for the motion there, that only smooth bodies have: c times lift
  /// and drag of the tail, eq. (115), and what (116) and (117) add to the lift of rotation (47).
  Wrench smoothLoad(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept;
  /// Friction of the smooth share's layer, eq. (114), at O for the velocity there.
  Vector3 layerForce(const Scalars& s, const Vector3& v) const noexcept;

 private:
  /// Numbers of both ways along the axes: +q_1, +q_2, +q_3, -q_1, -q_2, -q_3.
  using Ways = Eigen::Array<double, 6, 1, Eigen::DontAlign>;

  /// Constants that only smooth bodies have.
  struct Smooth {
    Matrix3 axes;                         ///< q_j of all scalars, in columns
    Matrix3 projections[3];               ///< q_j q_j^T
    Vector3 share;                        ///< chi_j
    Ways thickness_sq, layer;             ///< N^2, x of eq. (107)
    Ways laminar, bubble, smooth, rough;  ///< sigma of eq. (106)
    Ways bubble_friction, nose_friction;  ///< A_j chi_j f_B, A_j chi_j f_T of eq. (114) [m^2]
    Matrix3 uneven = Matrix3::Zero();     ///< nu_i times the weights of s_j in eq. (108)
    Matrix3 spin_mass;                    ///< rho V/2 diag((1 - nu_i)^4) in F [kg]
    double tail = 0, tail_place = 0;      ///< rho/2 A_1 C_t0 [kg/m], x_t [m]
    std::array<std::array<double, 4>, 2> tail_ways{};  ///< k_L, k_B, k_1, k_4 of +-q_1
  };

  void setTurning(const FluidBody& body, Smooth& to) const;
  void setWays(const FluidBody& body, const Vector3& own_drag, Smooth& to) const;
  void setTail(const FluidBody& body, const FormShape& shape, Smooth& to) const;
  double addLayers(Scalars& s, double reynolds, const Vector3& direction,
                   double turn_sq) const noexcept;
  void setAerofoils(const FluidBody& body);
  double alongAerofoils(const Scalars& s, double reynolds) const noexcept;
  Wrench tailLoad(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept;
  Vector3 spinForce(const Scalars& s, const Vector3& w, const Vector3& v) const noexcept;

  double density_, diameter_, area_, sharp_share_, relative_roughness_;
  double reynolds_per_speed_;  ///< [s/m]
  double aerofoils_ = 0;       ///< a of eq. (161f): share of the area that is wings with noses
  double aerofoil_chord_ = 1;  ///< their mean chord over D_A
  Resistance resistance_;
  Matrix3 turn_speed_;                    ///< 3 G/(2 D_A) [m]
  Matrix3 drag_;                          ///< R_vv/(3 pi D_A)
  double turn_drag_;                      ///< a third of its trace
  std::unique_ptr<const Smooth> smooth_;  ///< null: S = 1 in every motion
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
