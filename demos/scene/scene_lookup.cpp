#include "demos/scene/scene_lookup.h"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace ambient {
namespace {

namespace fs = std::filesystem;

fs::path programFolder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

bool looksLikePath(const std::string& text) {
  return text.find('/') != std::string::npos || fs::path(text).extension() == ".json";
}

}  // namespace

std::vector<fs::path> sceneFolders() {
  const fs::path program = programFolder();
  std::vector<fs::path> folders;
  for (const fs::path& folder :
       {fs::path("data/scenes"), program / "../../../data/scenes",
        program / "../share/bullet_ambient/scenes", fs::path(AMBIENT_SOURCE_SCENES)}) {
    std::error_code error;
    const fs::path real = fs::canonical(folder, error);
    if (!error && fs::is_directory(real) &&
        std::find(folders.begin(), folders.end(), real) == folders.end())
      folders.push_back(real);
  }
  return folders;
}

std::vector<fs::path> listScenes(const std::vector<fs::path>& folders) {
  std::map<std::string, fs::path> by_name;
  for (const fs::path& folder : folders)
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".json")
        by_name.emplace(entry.path().stem().string(), entry.path());
  std::vector<fs::path> files;
  for (const auto& [name, file] : by_name) files.push_back(file);
  return files;
}

fs::path findScene(const std::string& name_or_path, const std::vector<fs::path>& folders) {
  if (looksLikePath(name_or_path)) return name_or_path;
  std::string known;
  for (const fs::path& file : listScenes(folders)) {
    if (file.stem() == name_or_path) return file;
    known += (known.empty() ? "" : ", ") + file.stem().string();
  }
  throw std::runtime_error("scene \"" + name_or_path + "\" is not known; known are: " +
                           (known.empty() ? "none" : known) + "; or give the path of a .json file");
}

}  // namespace ambient
