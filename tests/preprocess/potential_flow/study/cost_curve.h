#pragma once

#include <string>

namespace ambient::study {

/// CSV: error over processor time of the added mass of several bodies on meshes of 80 to 5000
/// faces, by complete builds with and without what the solver adds to the mesh, and by the script
/// with point sources in numpy. The error is the larger one of rotation and translation.
/// @throws std::runtime_error if the script fails.
std::string costCurve(const std::string& script);

}  // namespace ambient::study
