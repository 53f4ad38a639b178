#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace ambient {

inline void writeText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// Every byte of a file; "" if there is none.
inline std::string readText(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace ambient
