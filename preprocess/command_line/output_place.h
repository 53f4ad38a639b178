#pragma once

#include <filesystem>

namespace ambient {

/// Finds out before the work, not after it, whether a file may be written there.
/// @throws std::runtime_error if its folder does not exist, it is a folder, or it is the input.
void requireWritablePlace(const std::filesystem::path& output, const std::filesystem::path& input);

}  // namespace ambient
