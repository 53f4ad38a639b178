#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace ambient::reference {

/// One flat face and the flow about it; lengths [m], SI units throughout.
struct FaceInFlow {
  Eigen::Vector3d normal, centroid;
  double area = 0;
  Eigen::Vector3d angular, linear;  ///< twist of the body relative to the fluid
  double density = 0, viscosity = 0, reference_length = 0;
  double separation_cosine = 0;

  Eigen::Vector3d velocity() const { return linear + angular.cross(centroid); }
  bool attached() const {
    const Eigen::Vector3d u = velocity();
    return normal.dot(u) > separation_cosine * u.norm();
  }
  /// u_s: the fluid's velocity relative to the wall.
  Eigen::Vector3d slip() const {
    if (!attached()) return Eigen::Vector3d::Zero();
    const Eigen::Matrix3d P = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    return -P * velocity();
  }
  Eigen::Vector3d pressureForce() const {
    return -0.5 * density * slip().squaredNorm() * area * normal;
  }
  Eigen::Vector3d frictionForce() const {
    const double speed = slip().norm();
    if (speed == 0) return Eigen::Vector3d::Zero();
    const double reynolds = density * speed * reference_length / viscosity;
    return 0.5 * 0.0576 * std::pow(reynolds, -0.2) * density * speed * area * slip();
  }
  /// Returns the wrench of a force on this face: torque about the origin, then force.
  Eigen::Matrix<double, 6, 1> wrenchOf(const Eigen::Vector3d& force) const {
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << centroid.cross(force), force;
    return wrench;
  }
};

}  // namespace ambient::reference
