#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/lanes/viscous_kernel.h"

// Water in the holds of bodies, docs/theory.md eq. (142), (152) to (154), of one body or of one
// body per lane, see spatial_lanes.h.

namespace ambient {
namespace {

/// Lets a mode and its body act on each other over `duration` [s] by the implicit midpoint rule,
/// eq. (153). Returns the twist after it, in B. `inverse`: K^-1.
template <class Real>
inline SpatialsOf<Real> exchangeSlosh(SloshOf<Real>& mode, const SymmetricOf<Real>& inverse,
                                      const Real& duration, const SpatialsOf<Real>& x) {
  const Real one = all<Real>(1), half = duration / 2;
  const MaskOf<Real> is_there = mode.mass > Real{};
  const Real mass = is_there ? mode.mass : one, stiffness = mass * mode.square;
  const Real loss = 2 * mode.damping * mass * squareRoot(mode.square);
  const SpatialsOf<Real> answer = inverse * mode.motion;
  const Real inverse_mass = one / mass + dot(mode.motion, answer);
  const Real rate =
      (mode.velocity - dot(mode.motion, x) - half * inverse_mass * stiffness * mode.way) /
      (one + half * inverse_mass * (loss + half * stiffness));
  const Real impulse = duration * (stiffness * (mode.way + half * rate) + loss * rate);
  mode.way = is_there ? mode.way + duration * rate : mode.way;
  mode.velocity = is_there ? mode.velocity - impulse / mass : mode.velocity;
  return select(is_there, x + impulse * answer, x);
}

/// Water in the holds of a body that has moved with it to another place. In B there.
template <class Real>
struct WaterShiftOf {
  SymmetricOf<Real> before, after;  ///< K_0, K_1
  SpatialsOf<Real> given;           ///< momentum that its sloshing gives the body [N m s, N s]
  Real energy2;                     ///< twice the energy that this gives [J]
  VectorsOf<Real> normal;           ///< unit normal of the surface, out of the water
};
template <class Real>
struct AfterShiftOf {
  SpatialsOf<Real> twist;
  MaskOf<Real> is_fine;  ///< false: K_1 is not positive definite, the twist of no meaning
};

/// Computes the twist after that from the one before, eq. (142), (154): the momentum of body and
/// water stays but for a torque along the tilt, by which the energy does, too, and it never grows.
template <class Real>
inline AfterShiftOf<Real> afterShift(const WaterShiftOf<Real>& p, const SpatialsOf<Real>& x) {
  const Real zero = Real{};
  const PositiveFactor<Real> factor(p.after);
  const SpatialsOf<Real> own = p.before * x, momentum = own + p.given;
  const Real allowed2 = dot(x, own) + p.energy2;
  const SpatialsOf<Real> free = factor.solve(momentum);
  // A torque along the tilt: the part of the spin across the normal.
  const VectorsOf<Real> tilt = free.angular - dot(p.normal, free.angular) * p.normal;
  const SpatialsOf<Real> response = factor.solve({tilt, {zero, zero, zero}});
  const Real a = dot(response.angular, tilt), b = dot(tilt, tilt);
  const Real excess = dot(free, momentum) - allowed2, square = b * b - a * excess;
  const MaskOf<Real> turns = (a > zero) & (square > zero);
  const Real root = b + squareRoot(turns ? square : zero);
  const SpatialsOf<Real> end =
      free - (turns ? excess / (turns ? root : all<Real>(1)) : zero) * response;
  return {scaleWithin(dot(end, p.after * end), larger(allowed2, zero)) * end, factor.isPositive()};
}

}  // namespace
}  // namespace ambient
