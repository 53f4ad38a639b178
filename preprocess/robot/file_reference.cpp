#include "preprocess/robot/file_reference.h"

#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

/// Empty: there is none.
fs::path findPackage(const std::string& name, const fs::path& file,
                     const PackageFolders& packages) {
  const auto given = packages.find(name);
  if (given != packages.end()) return given->second;
  std::error_code error;
  fs::path folder = fs::absolute(file, error).lexically_normal().parent_path();
  for (;; folder = folder.parent_path()) {
    if (folder.filename() == name) return folder;
    if (fs::is_directory(folder / name, error)) return folder / name;
    if (folder == folder.parent_path()) return {};
  }
}

}  // namespace

fs::path resolveReference(const std::string& reference, const fs::path& file,
                          const PackageFolders& packages, const std::string& source) {
  if (reference.empty()) raiseInputError(source, "the name of a file is empty");
  const std::size_t colon = reference.find("://");
  if (colon == std::string::npos) return file.parent_path() / reference;
  const std::string scheme = reference.substr(0, colon);
  const std::string rest = reference.substr(colon + 3);
  if (scheme == "file") return rest;
  if (scheme != "package" && scheme != "model")
    raiseInputError(source, "\"", reference, "\" begins with ", scheme,
                    "://; must be a path, file://, package:// or model://");
  const std::size_t slash = rest.find('/');
  const std::string name = rest.substr(0, slash);
  const fs::path folder = name.empty() ? fs::path() : findPackage(name, file, packages);
  if (folder.empty() || slash == std::string::npos)
    raiseInputError(source, "\"", reference, "\": no folder of package \"", name,
                    "\" was given or is above the file");
  return folder / rest.substr(slash + 1);
}

}  // namespace ambient
