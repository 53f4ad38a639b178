#pragma once

#include <chrono>
#include <filesystem>
#include <type_traits>

namespace ambient {

/// Folder of .ambient files that keeps fluid bodies for other runs and programs.
struct BodyFolder {
  BodyFolder() = default;
  template <class Path,
            class = std::enable_if_t<std::is_constructible_v<std::filesystem::path, const Path&>>>
  BodyFolder(const Path& folder, std::chrono::milliseconds least_time = {})
      : path(folder), least(least_time) {}

  std::filesystem::path path;          ///< made when first needed; empty: none
  std::chrono::milliseconds least{0};  ///< bodies that are made in less time get no file
};

/// Returns the folder of the user, in which PyBullet and Python keep what takes more than 50 ms:
/// $BULLET_AMBIENT_CACHE, else bullet_ambient in $XDG_CACHE_HOME or in ~/.cache. None if
/// BULLET_AMBIENT_CACHE is "off", or without a home.
BodyFolder userBodyFolder();

}  // namespace ambient
