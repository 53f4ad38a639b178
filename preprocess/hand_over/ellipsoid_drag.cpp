#include "preprocess/hand_over/ellipsoid_drag.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/polar/polar.h"

namespace ambient {
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
