#include "preprocess/floating/floating_energy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

// Second derivative of s.r by a turn of r, with the sign of a force along -s.
Matrix3 leverStiffness(const Vector3& s, const Vector3& r) {
  const Matrix3 product = s * r.transpose();
  return s.dot(r) * Matrix3::Identity() - 0.5 * (product + product.transpose());
}

constexpr double kRounding = 1e-12;

// The height of the plane at which the water carries the body: Newton's method within an interval
// that halving keeps.
void balance(const FloatingBody& body, const PackedHull& hull, FloatingPose& pose) {
  const auto [low, high] = computeExtent(hull, pose.plane.normal);
  const double wanted = body.mass / body.density;
  AMBIENT_ASSERT(body.mass > 0 && body.density > 0 && high > low);
  double below = low, above = high;
  pose.plane.height = (low + high) / 2;
  for (int i = 0; i < 100; ++i) {
    pose.wet = computeWetVolume(hull, pose.plane);
    const double excess = pose.wet.volume - wanted;
    if (std::abs(excess) <= kRounding * wanted) return;
    (excess > 0 ? above : below) = pose.plane.height;
    const double newton = pose.plane.height - excess / pose.wet.waterplane.area;
    pose.plane.height = newton > below && newton < above ? newton : (below + above) / 2;
  }
}

Matrix3 projector(const Vector3& normal) {
  return Matrix3::Identity() - normal * normal.transpose();
}

}  // namespace

PlaneEigen planeEigen(const Matrix3& matrix, const PlaneAxes& axes) {
  const auto& [e, f] = axes;
  const double a = e.dot(matrix * e), b = e.dot(matrix * f), d = f.dot(matrix * f);
  const double angle = 0.5 * portable::atan2(2 * b, a - d);
  const Vector3 large = portable::cos(angle) * e + portable::sin(angle) * f;
  const Vector3 small = -portable::sin(angle) * e + portable::cos(angle) * f;
  return {{small.dot(matrix * small), large.dot(matrix * large)}, {small, large}};
}

FloatingPose floatAt(const FloatingBody& body, const PackedHull& hull, const Vector3& up) {
  AMBIENT_ASSERT(isUnit(up));
  FloatingPose pose;
  pose.plane = {up, 0, body.density, body.gravity};
  balance(body, hull, pose);
  const double weight = body.mass * body.gravity;
  AMBIENT_ASSERT(pose.wet.volume > 0);
  const Vector3 lever = body.centre_of_mass - pose.wet.moment / pose.wet.volume;
  const Matrix3 in_plane = projector(up);
  pose.energy = hydrostaticEnergy(pose.wet, pose.plane) +
                weight * (up.dot(body.centre_of_mass) - pose.plane.height);
  pose.gradient = weight * (in_plane * lever);
  pose.stiffness =
      body.density * body.gravity * (in_plane * pose.wet.waterplane.spread * in_plane) -
      weight * up.dot(lever) * in_plane;
  return pose;
}

FloatingPose settle(const FloatingBody& body, const PackedHull& hull, const Vector3& up) {
  constexpr int kMostSteps = 200;
  constexpr double kLongest = 0.3;  // [rad]
  FloatingPose pose = floatAt(body, hull, up);
  const auto [low, high] = computeExtent(hull, up);
  const double scale = body.mass * body.gravity * (high - low);
  for (int i = 0; i < kMostSteps; ++i) {
    if (pose.gradient.norm() <= 1e-10 * scale) break;
    const PlaneEigen eigen = planeEigen(pose.stiffness, PlaneAxes(pose.plane.normal));
    Vector3 step = Vector3::Zero();
    for (std::size_t k = 0; k < 2; ++k) {
      const double stiffness = std::max(std::abs(eigen.values[k]), 1e-3 * scale);
      step -= eigen.vectors[k].dot(pose.gradient) / stiffness * eigen.vectors[k];
    }
    step *= std::min(1.0, kLongest / step.norm());
    bool is_lower = false;
    for (int halving = 0; halving < 30 && !is_lower; ++halving, step *= 0.5) {
      const FloatingPose next = floatAt(body, hull, (pose.plane.normal + step).normalized());
      // Near the end, where the energy's rounding hides it, by the gradient.
      is_lower = next.energy < pose.energy - kRounding * scale ||
                 (next.energy <= pose.energy + kRounding * scale &&
                  next.gradient.norm() < pose.gradient.norm());
      if (is_lower) pose = next;
    }
    if (!is_lower) break;
  }
  return pose;
}

Matrix6 restoringStiffness(const WetVolume& wet, const SurfacePlane& plane, const PointMass& weight,
                           const Vector3& point) {
  const Vector3& s = plane.normal;
  const Vector6 q = stack((wet.waterplane.centroid - point).cross(s), s);
  const Matrix3 turn = crossMatrix(s);
  Matrix6 K = wet.waterplane.area * q * q.transpose();
  K.topLeftCorner<3, 3>() += turn * wet.waterplane.spread * turn.transpose();
  K.topLeftCorner<3, 3>() += leverStiffness(s, wet.moment - wet.volume * point);
  K *= plane.density * plane.gravity;
  K.topLeftCorner<3, 3>() -= weight.mass * plane.gravity * leverStiffness(s, weight.centre - point);
  return K;
}

}  // namespace ambient
