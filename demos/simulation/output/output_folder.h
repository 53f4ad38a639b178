#pragma once

#include <filesystem>
#include <vector>

namespace ambient {

/// Creates a folder with its parents if needed. The destructor removes the folders created by this
/// object if they are empty, unless keep() was called.
class OutputFolder {
 public:
  /// @throws std::runtime_error naming the folder and why it cannot be made.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  void keep() { made_.clear(); }

  /// Folders created by this object, outermost first.
  const std::vector<std::filesystem::path>& made() const { return made_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;
};

}  // namespace ambient
