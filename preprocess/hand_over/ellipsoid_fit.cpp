#include "preprocess/hand_over/ellipsoid_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "preprocess/polar/polar.h"
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

namespace {

// Factors of the coefficients: of blunt or angular drag, and of slender drag.
struct DragAreas {
  Vector3 blunt, slender;
};

DragAreas silhouettes(const Vector3& a) {
  const Vector3 areas = kPi * Vector3(a[1] * a[2], a[2] * a[0], a[0] * a[1]);
  return {areas, Vector3::Constant(areas.maxCoeff()) - areas};
}

DragAreas moments(const Vector3& a) {
  constexpr double kSphere = 8.0 / 15 * kPi;
  Vector3 own, sorted = a;
  for (int k = 0; k < 3; ++k) {
    const double wide = std::max(a[(k + 1) % 3], a[(k + 2) % 3]);
    own[k] = kSphere * a[k] * (wide * wide) * (wide * wide);
  }
  std::sort(sorted.data(), sorted.data() + 3);
  const double largest = kSphere * sorted[1] * (sorted[2] * sorted[2]) * (sorted[2] * sorted[2]);
  return {own, Vector3::Constant(largest) - own};
}

// One over each drag, or over 1 % of the largest; 0 where there is none.
Vector3 weightsOf(const Vector3& drag) {
  if (!(drag.maxCoeff() > 0)) return Vector3::Zero();
  return drag.cwiseMax(0.01 * drag.maxCoeff()).cwiseInverse();
}

// The x >= 0 for which a x comes nearest to b.
double nearestFactor(const Vector3& a, const Vector3& b) {
  const double square = a.squaredNorm();
  return square > 0 ? std::max(0.0, a.dot(b) / square) : 0;
}

// Fits blunt and slender drag. A ball has no slender side.
EllipsoidDrag fitAlong(const Vector3& force, const DragAreas& along) {
  constexpr double kRounding = 1e-12;
  const Vector3 weights = weightsOf(force), right = weights.cwiseProduct(force);
  const Vector3 blunt = weights.cwiseProduct(along.blunt);
  const Vector3 slender = weights.cwiseProduct(along.slender);
  const double bb = blunt.squaredNorm(), ss = slender.squaredNorm(), bs = blunt.dot(slender);
  const double determinant = bb * ss - bs * bs;
  EllipsoidDrag fit{0, 0, 0};
  if (determinant > kRounding * bb * bb)
    fit.slender = std::max(0.0, (bb * slender.dot(right) - bs * blunt.dot(right)) / determinant);
  fit.blunt = nearestFactor(blunt, right - fit.slender * slender);
  return fit;
}

}  // namespace

Vector6 unitDrag(const EllipsoidDrag& drag, const Vector3& semi_axes) {
  const DragAreas along = silhouettes(semi_axes), about = moments(semi_axes);
  return stack(drag.angular * about.blunt + drag.slender * about.slender,
               drag.blunt * along.blunt + drag.slender * along.slender);
}

Vector6 unitDrag(const HandedBody& body, const EllipsoidFit& fit) {
  const BodyLoads loads(body.shape, {1, 0, Vector3::Zero(), Vector3::Zero()}, {});
  const FrameOffset to_ellipsoid{fit.axes.transpose(), -(fit.axes.transpose() * fit.centre)};
  Vector6 drag;
  for (int k = 0; k < 6; ++k) {
    const auto loadAt = [&](double speed) {
      const Twist motion = Twist::fromVector(speed * Vector6::Unit(k));
      return to_ellipsoid.toB(loads.at(to_ellipsoid.toF(motion)).total()).vector()[k];
    };
    drag[k] = std::max(0.0, (loadAt(-1) - loadAt(1)) / 2);
  }
  return drag;
}

EllipsoidDrag fitDrag(const Vector6& unit_drag, const Vector3& semi_axes) {
  const Vector3 force = unit_drag.tail<3>(), torque = unit_drag.head<3>();
  const DragAreas along = silhouettes(semi_axes), about = moments(semi_axes);
  EllipsoidDrag fit = fitAlong(force, along);
  const Vector3 weights = weightsOf(torque);
  fit.angular = nearestFactor(weights.cwiseProduct(about.blunt),
                              weights.cwiseProduct(torque - fit.slender * about.slender));
  return fit;
}

}  // namespace ambient
