#pragma once

#include <type_traits>

#include "bullet_ambient/fluid_body/form_factors.h"
#include "bullet_ambient/force/law/pressure_law.h"
#include "bullet_ambient/force/law/wing_pressure.h"

namespace ambient {

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

/// Complete q of eq. (43): windwardPressure() on the windward side, suction on the lee side.
template <class Real>
inline Real formPressure(const Real& normal_speed, const Real& speed,
                         const FormFactors<Real>& factors) {
  return windwardPressure(normal_speed, speed, factors) -
         (factors.by_lee * normal_speed) * normal_speed;
}

// Laws of the pressure on a face, for all sums over faces and for single faces. Each law has
//   of(face)
// which returns the FacePressure of a FaceState. withPressure() must list the law, too.

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

/// Pressure of the slip, docs/theory.md eq. (14).
struct PublishedPressure {
  static constexpr bool kPressesLee =
      false;  ///< true: faces on the lee side, which the flow has left, feel pressure
  static constexpr bool kIsSlender = false;  ///< `speed` is speedAcross()
  static constexpr bool kLifts = false;
  static constexpr bool kIsPart = false;      ///< of a wing of a body that has several parts
  static constexpr bool kHasFriction = true;  ///< of faces; the angle of separation may be larger
                                              ///< than pi/2
  using Windward = PublishedPressure;  ///< the law at a right angle without the lee side, which is
                                       ///< summed separately

  template <class Real, class... Functions>
  static FacePressure<Real> of(const FaceState<Real, Functions...>& face) {
    return {face.strength, Real{}};
  }
};

/// FormPressure without its lee, which is a quadratic form of the motion, addQuadraticPart().
template <bool kSlender>
struct WindwardFormPressure : PublishedPressure {
  static constexpr bool kIsSlender = kSlender;
  static constexpr bool kHasFriction = false;

  template <class Real, class... Functions>
  static FacePressure<Real> of(const FaceState<Real, Functions...>& face) {
    return {face.area * windwardPressure(face.normal_speed, face.speed(), face.factors()), Real{}};
  }
};

/// Form law of eq. (43) and (44) for blocks; `kSlender`: for smooth slender bodies that are no
/// wings.
template <bool kSlender>
struct FormPressure {
  static constexpr bool kPressesLee = true;
  static constexpr bool kIsSlender = kSlender;
  static constexpr bool kLifts = false;
  static constexpr bool kIsPart = false;
  static constexpr bool kHasFriction = false;
  using Windward = WindwardFormPressure<kSlender>;

  template <class Real, class... Functions>
  static FacePressure<Real> of(const FaceState<Real, Functions...>& face) {
    const Real pressure = face.area * formPressure(face.normal_speed, face.speed(), face.factors());
    return {pressure, Real{}};
  }
};

/// Form law of eq. (43) to (43d) for wings. `kLee`: with the lee side, which addQuadraticPart() can
/// sum for a whole body; `kSlender`: for wings that are slender, too; `kPart`: for one part of a
/// body.
template <bool kLee, bool kSlender, bool kPart = false>
struct WingPressure {
  static constexpr bool kPressesLee = kLee;
  static constexpr bool kIsSlender = kSlender;
  static constexpr bool kLifts = true;
  static constexpr bool kIsPart = kPart;
  static constexpr bool kHasFriction = false;
  using Windward = WingPressure<false, kSlender, kPart>;

  template <class Real, class... Functions>
  static FacePressure<Real> of(const FaceState<Real, Functions...>& face) {
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

 private:
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
  if (law != PressureLaw::kForm) return sum(PublishedPressure{});
  if (!wing) return sum(FormPressure<false>{});
  if (!wing->is_wing) return sum(FormPressure<true>{});
  if (wing->is_part) return sum(WingPressure<true, false, true>{});
  return wing->is_slender ? sum(WingPressure<true, true>{}) : sum(WingPressure<true, false>{});
}

}  // namespace ambient
