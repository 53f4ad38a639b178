#pragma once

#include <filesystem>

namespace ambient {

/// Checks before the work that a file can be written.
/// @throws std::runtime_error if its folder does not exist, it is a folder, or it is the input.
void requireWritablePlace(const std::filesystem::path& output, const std::filesystem::path& input);

/// Checks that a fluid body would replace no foreign file: only a file with extension .ambient, or
/// one that begins like such a file, or nothing.
/// @throws std::runtime_error in one line that names the file, if something else stands there.
void requireReplaceable(const std::filesystem::path& output);

}  // namespace ambient
