#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ambient {

/// Existing folders of named scenes, in order of priority: ./data/scenes; the source or install
/// tree of the running program; the source tree that the program was built
/// from.
std::vector<std::filesystem::path> sceneFolders();

/// Files of all named scenes, sorted by name; of equal names the file in the first folder.
std::vector<std::filesystem::path> listScenes(const std::vector<std::filesystem::path>& folders);

/// Returns the file of a scene, given by name or by the path of a JSON file.
/// @throws std::runtime_error with the known names if there is no such scene.
std::filesystem::path findScene(const std::string& name_or_path,
                                const std::vector<std::filesystem::path>& folders);

}  // namespace ambient
