#include "bullet_ambient/force/form_lift.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/spatial/ambient_assert.h"
#include "bullet_ambient/spatial/pi.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

constexpr double kStallIncidence = 0.45;  // delta, eq. (49)

/// 1 - f of eq. (49), from the lagged sin^2 of the incidence.
double separatedShare(double xi) noexcept {
  constexpr double kLargest = 1e8;  // beyond, the share is 0 or 1
  const double z = std::clamp(xi / kStallIncidence - 0.25, -kLargest, kLargest);
  return 0.5 * (1 + z / std::sqrt(1 + z * z));
}

}  // namespace

FormLift::FormLift(const FluidBody& body, double stall_lag) : centre_(body.centre_of_volume) {
  AMBIENT_ASSERT(stall_lag >= 0);
  const SymmetricEigen<3> eigen = symmetricEigen<3>(body.added_mass.bottomRightCorner<3, 3>());
  const Eigen::Vector3d& k = eigen.values;
  const Matrix3 axes = eigen.vectors;
  const Vector3 differences(k[2] - k[1], k[2] - k[0], k[1] - k[0]);
  circulation_ =
      body.volume / 2 * Matrix3::Identity() + axes * differences.asDiagonal() * axes.transpose();
  largest_ = k[2] - k[0];
  delay_ = 0;
  direction_ = Matrix3::Zero();
  if (!(largest_ > 0) || !(body.area > 0)) return;
  const Vector3 relative(0, (k[1] - k[0]) / largest_, 1);
  direction_ = axes * relative.asDiagonal() * axes.transpose();
  delay_ = 2 * stall_lag * 8 * largest_ / (kPi * body.area);
}

Wrench FormLift::load(const Twist& x, double density) const noexcept {
  const Vector3& w = x.angular;
  const Vector3 v = x.at(centre_);
  Wrench about_centre{Vector3::Zero(), (circulation_ * w).cross(v)};
  addStall(w, v, about_centre);
  const Vector3 force = density * about_centre.force;
  return {density * about_centre.torque + centre_.cross(force), force};
}

void FormLift::addStall(const Vector3& w, const Vector3& v, Wrench& about_centre) const noexcept {
  const double speed = v.norm();
  if (!(largest_ > 0) || !(speed > 0)) return;
  const Vector3 e = v / speed;
  const Vector3 across = direction_ * e;
  const Vector3 munk = across.cross(e);
  const double lagged = e.dot(across) - delay_ * (w.dot(munk) / speed);
  const double lost = separatedShare(lagged) * largest_ * speed;
  about_centre.torque -= lost * speed * munk;
  about_centre.force -= lost * across.cross(w);
}

}  // namespace ambient
