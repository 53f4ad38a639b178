#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fstream>
#include <string>
#include <vector>

namespace ambient::reference {

/// All vectors in world axes; linear acceleration = d(v_world)/dt.
struct AccelerationCase {
  Eigen::Quaterniond orientation;
  Eigen::Vector3d linear_velocity, angular_velocity;
  Eigen::Vector3d force, torque;
  Eigen::Vector3d linear_acceleration, angular_acceleration;
};

/// Accelerations of a body with a full 6x6 inertia, as full_inertia_accelerations.txt has them.
struct FullInertiaAccelerations {
  explicit FullInertiaAccelerations(const std::string& file_name) {
    std::ifstream file(file_name);
    for (std::string line; file.peek() == '#';) std::getline(file, line);
    const auto read = [&file](double* numbers, int count) {
      for (int i = 0; i < count; ++i) file >> numbers[i];
    };
    Eigen::Matrix<double, 6, 6> linear_first;  // symmetric
    read(linear_first.data(), 36);
    inertia << linear_first.bottomRightCorner<3, 3>(), linear_first.bottomLeftCorner<3, 3>(),
        linear_first.topRightCorner<3, 3>(), linear_first.topLeftCorner<3, 3>();
    for (double w; file >> w;) {
      AccelerationCase& c = cases.emplace_back();
      c.orientation.w() = w;
      for (double* vector : {c.orientation.vec().data(), c.linear_velocity.data(),
                             c.angular_velocity.data(), c.force.data(), c.torque.data(),
                             c.linear_acceleration.data(), c.angular_acceleration.data()})
        read(vector, 3);
    }
  }

  /// Total inertia, body plus added mass, body frame, rotation first. The body itself has mass 1
  /// and inertia identity.
  Eigen::Matrix<double, 6, 6> inertia;
  std::vector<AccelerationCase> cases;
};

}  // namespace ambient::reference
