#pragma once

#include <filesystem>

namespace ambient {

/// Finds out before the work, not after it, whether a file may be written there.
/// @throws std::runtime_error if its folder does not exist, it is a folder, or it is the input.
void requireWritablePlace(const std::filesystem::path& output, const std::filesystem::path& input);

/// Makes sure that a fluid body takes the place of another one, or of nothing: a file of that name
/// that is damaged, or what begins as an .ambient file.
/// @throws std::runtime_error in one line that names the file, if something else stands there.
void requireReplaceable(const std::filesystem::path& output);

}  // namespace ambient
