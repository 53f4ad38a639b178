#pragma once

#include <Eigen/Core>

namespace ambient {

// Fixed-size types of the numeric core. They are never over-aligned: programs compiled with other
// instruction-set flags than this library have the same layout of every struct. Headers for users
// write zeros and ones out: Eigen's Zero() and Identity() add a tenth of a second to the compile
// time of each user source. Cross products and the members of Quaternion need Eigen/Geometry,
// which spatial_vectors.h includes.
using Vector3 = Eigen::Matrix<double, 3, 1, Eigen::DontAlign>;
using Vector6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;
using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

}  // namespace ambient
