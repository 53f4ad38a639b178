#include "demos/simulation/output_files.h"

#include <unistd.h>

#include <algorithm>
#include <random>
#include <stdexcept>

namespace ambient {

namespace fs = std::filesystem;

namespace {

// Of this file and no other, also where programs of several machines write into one folder.
std::string uniqueText() {
  std::random_device random;
  return std::to_string(::getpid()) + "-" + std::to_string(random());
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder)
    : folder_(fs::absolute(folder).lexically_normal()) {
  for (fs::path at = folder_; !at.empty() && !fs::exists(at); at = at.parent_path())
    if (at.has_filename()) made_.insert(made_.begin(), at);
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_)) {
    const std::string reason = error ? error.message() : "it is not a folder";
    throw std::runtime_error(folder.string() + ": cannot be made: " + reason);
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  // remove() leaves a folder alone that is not empty.
  std::for_each(made_.rbegin(), made_.rend(), [&](const fs::path& at) { fs::remove(at, ignored); });
}

OutputFile::OutputFile(const fs::path& file)
    : file_(file),
      partial_(file.parent_path() /
               ("." + file.filename().string() + "." + uniqueText() + ".partial")),
      stream_(partial_, std::ios::binary | std::ios::trunc) {
  std::error_code error;
  if (fs::is_other(fs::status(file, error))) {  // renaming would replace a device
    fs::remove(partial_, error);
    throw std::runtime_error(file.string() + ": is not a regular file");
  }
  if (!stream_) throw std::runtime_error(file.string() + ": cannot be written");
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (!partial_.empty()) fs::remove(partial_, ignored);
}

void OutputFile::commit() {
  stream_.close();
  if (!stream_) throw std::runtime_error(file_.string() + ": could not be written completely");
  std::error_code error;
  fs::rename(partial_, file_, error);
  if (error) throw std::runtime_error(file_.string() + ": " + error.message());
  partial_.clear();
}

}  // namespace ambient
