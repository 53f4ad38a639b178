#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace ambient {

/// A file under a temporary name beside it until commit(): the old file or the new one, never half
/// of it. A symbolic link stays, what it leads to is replaced. Removed if commit() is never called.
class OutputFile {
 public:
  /// @throws std::runtime_error in one line that names the file, if it cannot be written or is a
  /// pipe or a device.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);
  /// Gives the file its name. @throws std::runtime_error as above, if anything was not written.
  void commit();

  /// Where the text stands until then.
  const std::filesystem::path& partial() const { return partial_; }

 private:
  std::filesystem::path file_;
  std::filesystem::path target_;
  std::filesystem::path partial_;
  std::ofstream stream_;
  int error_ = 0;  // of the first write that failed
};

/// What a path leads to if it is a symbolic link, which need not exist; else the path.
std::filesystem::path linkTarget(const std::filesystem::path& file);

}  // namespace ambient
