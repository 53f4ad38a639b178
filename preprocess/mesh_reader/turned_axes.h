#pragma once

#include <Eigen/Core>
#include <string>

namespace ambient {

/// One line about how assimp has turned the axes of a file, empty if it has not. Formats that say
/// nothing of their axes keep them; the readers of some old ones turn z into y, by the root of the
/// scene, whose linear part is `root`.
std::string turnedAxesWarning(const std::string& extension, const Eigen::Matrix3d& root);

}  // namespace ambient
