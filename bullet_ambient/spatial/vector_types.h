#pragma once

#include <Eigen/Core>

namespace ambient {

// Fixed-size types of the numeric core. They are never over-aligned, so that a program compiled
// with other instruction-set flags than this library still agrees with it on the layout of every
// struct. Headers that users include spell zeros and ones: Eigen's Zero() and Identity() take a
// tenth of a second to compile in each of their sources. Cross products and the content of
// Quaternion are in Eigen/Geometry: spatial_vectors.h.
using Vector3 = Eigen::Matrix<double, 3, 1, Eigen::DontAlign>;
using Vector6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;
using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

}  // namespace ambient
