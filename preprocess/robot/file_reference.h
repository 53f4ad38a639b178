#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace ambient {

/// Folders of packages by name, for references package://NAME/...
using PackageFolders = std::map<std::string, std::filesystem::path>;

/// Finds the file that a reference in `file` means:
///
///     meshes/hull.stl          beside the file
///     /data/hull.stl           as it is; file:///data/hull.stl is the same
///     package://rover/hull.stl in the folder of the package rover: the one that was given; else
///                              the nearest folder above the file that is called rover or holds a
///                              folder rover; model:// is the same
///
/// Environment variables are not read. Whether the file exists is not checked.
/// @throws std::runtime_error in one line that begins with `source`: another scheme, an empty name,
/// a package that was not found.
std::filesystem::path resolveReference(const std::string& reference,
                                       const std::filesystem::path& file,
                                       const PackageFolders& packages, const std::string& source);

}  // namespace ambient
