#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace ambient {

/// Writes a file completely or not at all: text goes to a temporary file in the same folder, which
/// commit() renames. Without commit() the temporary file is removed. A symbolic link is followed.
class OutputFile {
 public:
  /// Opens the temporary file. @throws std::runtime_error in one line that names the file, if the
  /// file cannot be written or is a pipe or a device.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);  ///< appends text; commit() reports errors
  /// Renames the temporary file. @throws std::runtime_error in one line, if any write failed.
  void commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path target_;
  std::filesystem::path partial_;
  std::ofstream stream_;
  int error_ = 0;  // errno of the first write that failed; 0: none
};

/// Writes a file completely or not at all. @throws std::runtime_error as OutputFile
void writeFile(const std::filesystem::path& file, std::string_view text);

/// Follows symbolic links to their target, which need not exist; other paths stay as they are.
std::filesystem::path linkTarget(const std::filesystem::path& file);

}  // namespace ambient
