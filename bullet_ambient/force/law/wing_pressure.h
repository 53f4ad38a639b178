#pragma once

namespace ambient {

// Pressure of the form law on wings, docs/theory.md eq. (43a) to (43c), (161). The code serves
// numbers and vectors of numbers: the same bits everywhere with the same Arithmetic.

/// Constants of a shape in these equations, folded so that a face needs few operations; with
/// k = W^(1/4) / (4 sigma^2). Plain data, for kernels; `Number`: float or double.
template <class Number>
struct WingFactors {
  Number wing_root = 0;   ///< sqrt(W)
  Number stall = 0;       ///< k
  Number slope = 0;       ///< K / k
  Number facing[3] = {};  ///< z
  /// sqrt((K - K') / k) h; where K' is larger, sqrt((K' - K) / k) times the direction across z and
  /// h, with K' in `slope`.
  Number span[3] = {};
  Number slender[3] = {};   ///< m
  bool is_wing = false;     ///< W is not 0
  bool is_slender = false;  ///< m is not 0
  bool is_part = false;     ///< a wing of a body that has several parts, eq. (161)
};

/// Sums of products with two roundings. Kernels that fuse have functions of the same names.
template <class Number>
struct PlainArithmetic {
  using Real = Number;
  static Real plus(const Real& c, const Real& a, const Real& b) { return c + a * b; }
  static Real less(const Real& c, const Real& a, const Real& b) { return c - a * b; }
  static Real positive(const Real& x) { return x > Real{} ? x : Real{}; }
};

/// Motion of a face against the fluid, as far as it decides on lift.
template <class Sums>
struct WingFlow {
  using Arithmetic = Sums;
  using Real = typename Sums::Real;
  Real facing;    ///< z.u [m/s]
  Real stalling;  ///< (1 - chi) z.u of eq. (161); of a body that is one part z.u
  Real span;      ///< WingFactors::span . u
  Real lifting;   ///< nu [m/s]
  Real speed_sq;  ///< |u|^2; at rest any positive number whose inverse is finite
  Real speed;     ///< its root
};

constexpr double kLeastSpeedSq = 1e-200;  ///< for WingFlow::speed_sq: at rest its inverse is finite

/// Attached flow on a face.
template <class Real>
struct AttachedFlow {
  Real share;  ///< W A, eq. (43a)
  Real lift;   ///< its q_L, eq. (43b): what turns the flow, and the vortices of the edges
};

/// Computes eq. (43a) and (43b). `normal_speed`: n.u [m/s].
template <class Flow, class Real, class Number>
inline AttachedFlow<Real> attachedFlow(const Real& normal_speed, const Flow& flow,
                                       const WingFactors<Number>& factors) {
  using Sum = typename Flow::Arithmetic;
  constexpr auto kVortices = static_cast<Number>(3.14159265358979323846);
  const Real inverse = factors.stall / flow.speed_sq;
  const Real across_sq = Sum::plus(normal_speed * normal_speed, flow.stalling, flow.facing);
  const Real incidence = across_sq * inverse;
  const Real root = Sum::positive(Sum::less(Real{} + factors.wing_root, incidence, incidence));
  const Real in_plane_sq = Sum::positive(Sum::less(flow.speed_sq, flow.facing, flow.facing));
  const Real turned = Sum::less(factors.slope * in_plane_sq, flow.span, flow.span);
  const Real lifting = Sum::positive(flow.lifting), share = root * root;
  return {share, (share * lifting) * Sum::plus(kVortices * lifting, turned * flow.speed, inverse)};
}

}  // namespace ambient
