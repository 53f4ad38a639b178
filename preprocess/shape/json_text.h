#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ambient {

/// Reads a file.
/// @throws std::runtime_error in one line that names the file, if it cannot be read.
std::string readBytes(const std::filesystem::path& file);

/// Parses JSON; a key given twice in one object is an error.
/// @throws std::runtime_error in one line that begins with `source`.
nlohmann::json parseJson(const std::string& text, const std::string& source);

}  // namespace ambient
