#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace ambient {

/// A folder that is made when needed, parents included; those it made itself vanish again with it
/// unless keep() was called.
class OutputFolder {
 public:
  /// @throws std::runtime_error naming the folder and why it cannot be made.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  void keep() { made_.clear(); }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // outermost first
};

/// A text file under a temporary name in its folder until commit(); removed if that never happens.
class OutputFile {
 public:
  /// @throws std::runtime_error naming the file if it cannot be written.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const std::string& text) { stream_ << text; }
  /// Gives the file its name. @throws std::runtime_error if not everything could be written.
  void commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path partial_;
  std::ofstream stream_;
};

}  // namespace ambient
