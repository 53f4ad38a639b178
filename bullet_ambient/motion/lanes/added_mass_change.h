#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Change of added mass where a body enters or leaves the water, docs/theory.md eq. (66) to (68), of
// one body or of one body per lane, see spatial_lanes.h.

namespace ambient {
namespace {

/// Change of the total inertia of a body from one pose to another, and geometry. In B at
/// the second pose; the gradient may be that of the first pose.
template <class Real>
struct AddedMassChangeOf {
  const SymmetricOf<Real>& before;         ///< K_0
  const SymmetricOf<Real>& after;          ///< K_1
  const SymmetricOf<Real>& inverse_after;  ///< K_1^-1
  SpatialsOf<Real> gradient;               ///< F_K of eq. (66), for the twist before [N m, N]
  VectorsOf<Real> normal;                  ///< unit normal of the surface, out of the water
  VectorsOf<Real> centre_of_buoyancy;      ///< [m]
  Real draught, submergence;               ///< MeanDepths [m]
  Real gravity;                            ///< [m/s^2], >= 0
  Real duration;                           ///< [s], > 0
  Real velocity_scale = {};                ///< second term of the denominator of eq. (25) [sqrt(J)]
};

/// Returns theta sigma of eq. (67), the share of the momentum that goes into spray, in [-1, 1].
template <class Real>
inline Real sprayShare(const AddedMassChangeOf<Real>& p, const SpatialsOf<Real>& x) {
  const Real zero = Real{}, one = all<Real>(1);
  const VectorsOf<Real> v = x.linear + cross(x.angular, p.centre_of_buoyancy);
  const Real sinking = zero - dot(p.normal, v), speed = squareRoot(dot(v, v));
  const Real still = sinking * sinking + p.gravity * p.draught;
  const MaskOf<Real> moves = (speed > zero) & (still > zero) & (p.draught > zero);
  const Real open = 1 - 4 * larger(p.submergence, zero) / (moves ? p.draught : one);
  const Real open_share = larger(open < one ? open : one, zero);
  const Real theta = sinking * sinking / (moves ? still : one) * open_share;
  const Real down = 2 * sinking / (moves ? speed : one);
  const Real sigma = larger<Real>(down < one ? down : one, -one);
  return moves ? theta * sigma : zero;
}

/// Returns F_K dt. The force is multiplied by r of eq. (68), so that its work equals the change of
/// the kinetic energy by that of K, if r is between 0 and 3. The torque stays, because it belongs
/// to the gyroscopic terms of the flow. Works at the twist x before the change: of_gradient,
/// F_K . x dt; of_change, half of x . (K_1 - K_0) x [J].
template <class Real>
inline SpatialsOf<Real> gradientImpulse(const AddedMassChangeOf<Real>& p, const Real& of_gradient,
                                        const Real& of_change) {
  constexpr double kMostCorrection = 3;
  const Real ratio = of_change / of_gradient;
  const MaskOf<Real> is_near = (ratio > Real{}) & (ratio < all<Real>(kMostCorrection));
  const Real scale = p.duration * (is_near ? ratio : all<Real>(1));
  return {p.duration * p.gradient.angular, scale * p.gradient.linear};
}

template <class Real>
inline Real largestEntry(const SymmetricOf<Real>& K) {
  Real largest = Real{};
  for (const Real& number : K.entries) largest = larger(larger<Real>(number, -number), largest);
  return largest;
}

/// Twist after the change. The kinetic energy x.K x never grows. Horizontal momentum, and angular
/// momentum about the vertical, are kept unless this bound acts.
template <class Real>
struct AfterChangeOf {
  SpatialsOf<Real> twist;
  Real energy_removed;  ///< by the bound [J]
  Real error;           ///< relative to the motion, eq. (68b) [1]
};

/// Returns eq. (68b): the velocity that F_K of one pose misses, over the motion. `missed_work`:
/// that of the change less that of F_K [J]; `twice_energy`: x . K_0 x.
template <class Real>
inline Real changeError(const AddedMassChangeOf<Real>& p, const Real& missed_work,
                        const Real& spray_share, const Real& twice_energy) {
  const Real norm = squareRoot(twice_energy), scale = norm * (norm + p.velocity_scale);
  const Real missed = (1 - spray_share) * missed_work;
  const MaskOf<Real> moves = scale > Real{};
  return moves ? larger<Real>(missed, -missed) / (moves ? scale : all<Real>(1)) : Real{};
}

/// Computes the twist after the change from the twist x before, eq. (66) to (68): momentum passes
/// between water and body, or into spray. A body whose K has not changed keeps its twist.
template <class Real>
inline AfterChangeOf<Real> applyAddedMassChange(const AddedMassChangeOf<Real>& p,
                                                const SpatialsOf<Real>& x) {
  constexpr double kRounding = 1e-12;
  const Real zero = Real{};
  const SymmetricOf<Real> change = p.after - p.before;
  const MaskOf<Real> changes = largestEntry(change) >= kRounding * largestEntry(p.before);
  const Real of_gradient = p.duration * dot(p.gradient, x), of_change = 0.5 * dot(x, change * x);
  SpatialsOf<Real> impulse = gradientImpulse(p, of_gradient, of_change);
  const Real spray_share = sprayShare(p, x);
  const Real lost = spray_share * larger<Real>(zero - dot(p.normal, impulse.linear), zero);
  impulse = impulse + lost * SpatialsOf<Real>{cross(p.centre_of_buoyancy, p.normal), p.normal};
  const SpatialsOf<Real> momentum = p.before * x;
  const SpatialsOf<Real> end = p.inverse_after * (momentum + impulse);
  const Real allowed2 = dot(x, momentum), energy2 = dot(end, p.after * end);
  const MaskOf<Real> gains = changes & (energy2 > allowed2);
  return {select(changes, scaleWithin(energy2, allowed2) * end, x),
          gains ? 0.5 * (energy2 - allowed2) : zero,
          changes ? changeError<Real>(p, of_change - of_gradient, spray_share, allowed2) : zero};
}

}  // namespace
}  // namespace ambient
