#pragma once

#include <string>

namespace ambient::study {

/// Markdown: errors and times of a complete build and of the numpy script with point sources, on
/// meshes of spheroids with about 1350 vertices.
/// @throws std::runtime_error if the script fails.
std::string pointSourceRace(const std::string& script);

}  // namespace ambient::study
