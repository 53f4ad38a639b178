#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ambient {

/// The folders that hold named scenes, most specific first: ./data/scenes, the source or install
/// tree that the running program belongs to, the source tree it was built from. Only those that
/// exist.
std::vector<std::filesystem::path> sceneFolders();

/// All named scenes, sorted by name; a name found in two folders is taken from the first.
std::vector<std::filesystem::path> listScenes(const std::vector<std::filesystem::path>& folders);

/// The file of a scene given by name, or by the path of a JSON file.
/// @throws std::runtime_error with the known names if there is none.
std::filesystem::path findScene(const std::string& name_or_path,
                                const std::vector<std::filesystem::path>& folders);

}  // namespace ambient
