#pragma once

namespace ambient {

// Pressure of the form law on wings, docs/theory.md eq. (43a) to (43c). The code serves numbers and
// vectors of numbers with the same roundings: the same bits everywhere.

/// Constants of a shape in these equations. Plain data, for kernels; `Number`: float or double.
template <class Number>
struct WingFactors {
  Number wing = 0;           ///< W
  Number per_stall = 0;      ///< 1 / (4 sigma^2)
  Number slope = 0;          ///< K(L)
  Number further_slope = 0;  ///< K(1/L) - K(L)
  Number facing[3] = {};     ///< z
  Number span[3] = {};       ///< h
  Number slender[3] = {};    ///< m
  bool is_slender = false;   ///< m is not 0
};

/// Motion of a face against the fluid, as far as it decides on lift.
template <class Real>
struct WingFlow {
  Real facing;         ///< z.u [m/s]
  Real span;           ///< h.u [m/s]
  Real lifting;        ///< nu [m/s]
  Real speed_sq;       ///< |u|^2
  Real inverse_speed;  ///< 1 / |u|; any finite number at rest
};

/// W A: share of the face that the flow has not left, eq. (43a). `normal_speed`: n.u [m/s].
template <class Real, class Number>
inline Real attachedShare(const Real& normal_speed, const WingFlow<Real>& flow,
                          const WingFactors<Number>& factors) {
  const Real zero = {};
  const Real incidence = (normal_speed * normal_speed + flow.facing * flow.facing) *
                         (flow.inverse_speed * flow.inverse_speed) * factors.per_stall;
  const Real left = static_cast<Number>(1) - incidence * incidence;
  const Real attached = left > zero ? left : zero;
  return (factors.wing * attached) * attached;
}

/// q of attached flow over its share, eq. (43b): what turns the flow, and the vortices of the
/// edges.
template <class Real, class Number>
inline Real liftPressure(const WingFlow<Real>& flow, const WingFactors<Number>& factors) {
  constexpr auto kVortices = static_cast<Number>(3.14159265358979323846);
  const Real zero = {};
  const Real in_plane = flow.speed_sq - flow.facing * flow.facing;
  const Real in_plane_sq = in_plane > zero ? in_plane : zero;
  const Real turned = factors.slope * in_plane_sq + factors.further_slope * (flow.span * flow.span);
  const Real lifting = flow.lifting > zero ? flow.lifting : zero;
  return lifting * (turned * flow.inverse_speed + kVortices * lifting);
}

}  // namespace ambient
