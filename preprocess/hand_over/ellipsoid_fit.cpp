#include "preprocess/hand_over/ellipsoid_fit.h"

#include <array>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

namespace ambient {
namespace {

// Lamb's alpha_0, beta_0, gamma_0 by the added masses m of an ellipsoid of volume V: m = V a/(2 -
// a).
Vector3 shapeFactors(const Vector3& m, double volume) {
  return 2 * m.array() / (volume + m.array());
}

// The volume V of the ellipsoid: sum m_k / (V + m_k) = 1, or V^3 - e_2 V - 2 e_3 = 0 by the
// elementary symmetric functions of m. Newton's method comes down from above.
double volumeOf(const Vector3& m) {
  const double e2 = m[0] * m[1] + m[1] * m[2] + m[2] * m[0], e3 = m.prod();
  double volume = 2 * m.maxCoeff();
  for (int i = 0; i < 100; ++i) {
    const double next = (2 * volume * volume * volume + 2 * e3) / (3 * volume * volume - e2);
    if (!(next < volume)) break;
    volume = next;
  }
  return volume;
}

// The shift d to where the coupling C - [d]x M is least; M is the translation block.
Vector3 leastCoupling(const Matrix6& added_mass) {
  const Matrix3 mass = added_mass.bottomRightCorner<3, 3>();
  const Matrix3 coupling = added_mass.topRightCorner<3, 3>();
  Matrix3 normal;
  Vector3 right;
  std::array<Matrix3, 3> by;
  for (int k = 0; k < 3; ++k)
    by[static_cast<std::size_t>(k)] = crossMatrix(Vector3::Unit(k)) * mass;
  for (int k = 0; k < 3; ++k) {
    const Matrix3& by_k = by[static_cast<std::size_t>(k)];
    right[k] = by_k.cwiseProduct(coupling).sum();
    for (int l = 0; l < 3; ++l)
      normal(k, l) = by_k.cwiseProduct(by[static_cast<std::size_t>(l)]).sum();
  }
  // A sheet has no mass along itself: a shift along its normal couples nothing.
  constexpr double kFree = 1e-9;
  normal.diagonal().array() += kFree * normal.trace();
  return Cholesky<3>(normal).solve(right);
}

}  // namespace

// A longer semi-axis has a smaller factor. Each step corrects the logarithms of the semi-axes by
// half the error of their factors, which brings the ratios at least twice as near.
Vector3 semiAxesOf(const Vector3& added_mass) {
  constexpr double kThinnest = 1e-5, kRounding = 1e-14, kUnitVolume = 4 * kPi / 3;
  const Vector3 m = added_mass.cwiseMax(kThinnest * added_mass.maxCoeff());
  const double volume = volumeOf(m);
  const Vector3 wanted = shapeFactors(m, volume);
  Vector3 semi_axes = Vector3::Ones();
  for (int i = 0; i < 200; ++i) {
    const Vector3 factors = shapeFactors(ellipsoidAddedMass(semi_axes).tail<3>(), kUnitVolume);
    const Vector3 ratio = factors.cwiseQuotient(wanted);
    semi_axes = semi_axes.cwiseProduct(ratio.cwiseSqrt());
    semi_axes /= portable::cbrt(semi_axes.prod());
    if ((ratio.array() - 1).abs().maxCoeff() < kRounding) break;
  }
  return semi_axes * portable::cbrt(volume / kUnitVolume);
}

EllipsoidFit fitEllipsoid(const Matrix6& added_mass, const Vector3& middle) {
  const PrincipalFrame frame = findPrincipalFrame(added_mass.bottomRightCorner<3, 3>());
  const Vector3 centre = middle + leastCoupling(shiftOrigin(added_mass, middle));
  return {semiAxesOf(frame.moments), centre, frame.rotation};
}

}  // namespace ambient
