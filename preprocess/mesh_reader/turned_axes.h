#pragma once

#include <Eigen/Core>
#include <string>

namespace ambient {

/// Returns one line that says how assimp has turned the axes of a file; empty if it has not. The
/// readers of some old formats turn z into y by the root node of the scene, whose linear part is
/// `root`.
std::string turnedAxesWarning(const std::string& extension, const Eigen::Matrix3d& root);

}  // namespace ambient
