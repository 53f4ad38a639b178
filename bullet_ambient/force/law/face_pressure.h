#pragma once

#include <type_traits>

#include "bullet_ambient/fluid_body/form_factors.h"
#include "bullet_ambient/force/law/pressure_law.h"

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

namespace {

/// Share of a face's area in the fluid, docs/theory.md eq. (59), per lane; for kernels. `depth`:
/// zeta of the barycentre; `cosine`: n.s; `radius_sq`: squared radius of the disc with the area of
/// the face; `root`: square root of lanes. All lengths in one unit.
template <class Lanes, class Root>
inline Lanes wetShareOf(Lanes depth, Lanes cosine, Lanes radius_sq, const Root& root) {
  constexpr float kLeastTilt = 1e-4f;     // 10^-4 of eq. (59): a face parallel to the surface gets
                                          // wet over a hundredth of its radius
  constexpr float kLeastSquare = 1e-30f;  // avoids 0 / 0 for faces without area
  const Lanes zero = {}, one = zero + 1.0f;
  const Lanes reach_sq = radius_sq * (one + kLeastTilt - cosine * cosine) + kLeastSquare;
  const Lanes share = 0.5f + 0.5f * (depth / root(reach_sq));
  const Lanes positive = share > zero ? share : zero;
  return positive < one ? positive : one;
}

}  // namespace

// Pressure of the form law, docs/theory.md eq. (43) and (44). The code serves numbers and vectors
// of numbers with the same roundings: the same bits everywhere.

/// |u| as eq. (43) sees it on a slender body: u_n + |t_m|^2/(|u| + u_n), with the squared slip
/// across the body's axis, |t_m|^2. On the windward side only; elsewhere any finite number, 0 where
/// |u| + u_n is 0, at rest and where the face moves straight away from the fluid.
template <class Real>
inline Real speedAcross(const Real& normal_speed, const Real& slip_across_sq, const Real& speed) {
  const Real zero = {}, sum = speed + normal_speed;
  const Real across_sq = slip_across_sq > zero ? slip_across_sq : zero;
  const Real across = normal_speed + across_sq / sum;
  return sum > zero ? across : zero;
}

/// Windward part of q of eq. (43), 0 on the lee side; the pressure is -rho/2 q. `normal_speed` is
/// n.u, the velocity into the fluid; `speed` is |u| [m/s].
template <class Real>
inline Real windwardPressure(const Real& normal_speed, const Real& speed,
                             const FormFactors<Real>& factors) {
  const Real zero = {};
  const Real pressure =
      normal_speed * (factors.by_normal * normal_speed + factors.by_speed * speed);
  return normal_speed > zero ? pressure : zero;
}

/// Motion of a face, and further quantities as functions, which only laws that need them call.
/// `Real`: a number or a vector of numbers.
template <class Real, class Speed, class Factors, class Wing>
struct FaceState {
  Real normal_speed;  ///< n.u, the velocity into the fluid [m/s]
  Real area;          ///< A
  Real strength;      ///< |u_s|^2 A where the flow is attached, else 0
  Speed speed;        ///< |u|; on a slender body speedAcross()
  Factors factors;    ///< FormFactors of the face
  Wing wing;          ///< takes a function of WingFlow and WingFactors, returns its result
};
template <class Real, class Speed, class Factors, class Wing>
FaceState(Real, Real, Real, Speed, Factors, Wing) -> FaceState<Real, Speed, Factors, Wing>;

/// q A for the pressure rho/2 q on a face of area A: total, and the part that is lift of attached
/// flow.
template <class Real>
struct FacePressure {
  Real total, lift;
};

/// Law of the pressure on a face, for all sums over faces and for single faces: that of the slip,
/// docs/theory.md eq. (14), or with `kForm` the form law, (43) and (44), with `kWing` (43) to
/// (43d). kSlender: `speed` is speedAcross(); kPart: of a wing of a body that has several parts;
/// kLee: faces on the lee side, which the flow has left, feel pressure.
template <bool kForm, bool kWing = false, bool kSlender = false, bool kPart = false,
          bool kLee = kForm>
struct FaceLaw {
  static constexpr bool kPressesLee = kLee;
  static constexpr bool kIsSlender = kSlender;
  static constexpr bool kLifts = kWing;
  static constexpr bool kIsPart = kPart;
  /// Of faces; the angle of separation may be larger than pi/2.
  static constexpr bool kHasFriction = !kForm;
  /// The law at a right angle without its lee side, which is a quadratic form of the motion of a
  /// whole body, addQuadraticPart().
  using Windward = FaceLaw<kForm, kWing, kSlender, kPart, false>;

  template <class Real, class... Functions>
  static FacePressure<Real> of(const FaceState<Real, Functions...>& face) {
    if constexpr (kWing)
      return ofWing<Real>(face);
    else if constexpr (kForm)
      return {face.area * formPressure(face), Real{}};
    else
      return {face.strength, Real{}};
  }

 private:
  template <class Face>
  static auto formPressure(const Face& face) {
    const auto factors = face.factors();
    const auto windward = windwardPressure(face.normal_speed, face.speed(), factors);
    if constexpr (!kLee)
      return windward;
    else
      return windward - (factors.by_lee * face.normal_speed) * face.normal_speed;
  }

  template <class Real, class Face>
  static FacePressure<Real> ofWing(const Face& face) {
    return face.wing([&](const auto& flow, const auto& numbers) {
      using Sum = typename std::decay_t<decltype(flow)>::Arithmetic;
      const AttachedFlow<Real> attached = attachedFlow(face.normal_speed, flow, numbers);
      const auto factors = face.factors();
      const Real zero = {}, u = Sum::positive(face.normal_speed);
      const Real whole = Sum::plus(factors.by_speed * speedOf(face, flow), factors.by_normal, u);
      const Real flat = Sum::less(whole, factors.by_lee, u);
      const Real kept = Sum::less(kLee ? flat : whole, attached.share, flat);
      const Real lift = face.area * attached.lift;
      Real pressure = Sum::plus(lift, face.area * u, kept);
      if constexpr (kLee) {
        const Real lee = face.normal_speed < zero ? face.normal_speed : zero;
        pressure = Sum::less(pressure, (face.area * factors.by_lee) * lee, lee);
      }
      return FacePressure<Real>{pressure, lift};
    });
  }

  template <class Face, class Flow>
  static auto speedOf(const Face& face, const Flow& flow) {
    if constexpr (kSlender) return face.speed();
    return flow.speed;
  }
};

/// Calls sum(Law{}) with the law for a setting and a shape. `wing`: factors of the shape; null for
/// a block and for the published law.
template <class Number, class Sum>
auto withPressure(PressureLaw law, const WingFactors<Number>* wing, const Sum& sum) {
  if (law != PressureLaw::kForm) return sum(FaceLaw<false>{});
  if (!wing) return sum(FaceLaw<true>{});
  if (!wing->is_wing) return sum(FaceLaw<true, false, true>{});
  if (wing->is_part) return sum(FaceLaw<true, true, false, true>{});
  return wing->is_slender ? sum(FaceLaw<true, true, true>{}) : sum(FaceLaw<true, true>{});
}

}  // namespace ambient
