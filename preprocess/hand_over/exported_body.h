#pragma once

#include <filesystem>
#include <string>

namespace ambient {

/// A fluid body in the file format of another program.
struct ExportedBody {
  std::string bytes;   ///< content of the file, text
  std::string report;  ///< lines for people on what the format leaves out; may be empty

  /// Writes the file completely or not at all.
  /// @throws std::runtime_error in one line that names the file, if it cannot be written.
  void write(const std::filesystem::path& file) const;
};

}  // namespace ambient
