#include "demos/simulation/output/output_folder.h"

#include <algorithm>
#include <stdexcept>

namespace ambient {

namespace fs = std::filesystem;

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
  // remove() fails for a folder that is not empty.
  std::for_each(made_.rbegin(), made_.rend(), [&](const fs::path& at) { fs::remove(at, ignored); });
}

}  // namespace ambient
