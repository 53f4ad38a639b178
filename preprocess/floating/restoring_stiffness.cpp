#include "preprocess/floating/restoring_stiffness.h"

#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

// Second derivative of s.r by a turn of r, with the sign of a force along -s.
Matrix3 leverStiffness(const Vector3& s, const Vector3& r) {
  const Matrix3 product = s * r.transpose();
  return s.dot(r) * Matrix3::Identity() - 0.5 * (product + product.transpose());
}

}  // namespace

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
