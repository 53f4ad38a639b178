#pragma once

#include <string>

namespace ambient::study {

/// CSV: error over processor time of several bodies' added mass on meshes of 80 to 5000 faces.
/// Methods: complete builds with and without mesh corrections, and the numpy script with point
/// sources. Error: the larger one of rotation and translation.
/// @throws std::runtime_error if the script fails.
std::string costCurve(const std::string& script);

}  // namespace ambient::study
