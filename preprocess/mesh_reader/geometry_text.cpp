#include "preprocess/mesh_reader/geometry_text.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace ambient {
namespace {

// "f 1/2/3 4//5" becomes "f 1 4".
std::string withoutSlashes(const std::string& obj) {
  std::string text;
  bool leaves_out = false;
  for (const char c : obj) {
    const bool is_space = std::isspace(static_cast<unsigned char>(c)) != 0;
    leaves_out = !is_space && (leaves_out || c == '/');
    if (!leaves_out) text += c;
  }
  return text;
}

std::string withoutElements(std::string xml, const std::string& name) {
  const std::string begin = "<" + name, end = "</" + name + ">";
  std::size_t first = 0;
  while ((first = xml.find(begin, first)) != std::string::npos) {
    const std::size_t close = xml.find('>', first);
    if (close == std::string::npos) return xml;
    const std::size_t last = xml[close - 1] == '/' ? close + 1 - end.size() : xml.find(end, close);
    if (last == std::string::npos) return xml;
    xml.erase(first, last + end.size() - first);
  }
  return xml;
}

}  // namespace

std::string readText(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw std::runtime_error("cannot be read");
  return text;
}

std::string extensionOf(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::optional<std::string> geometryText(const std::string& file) {
  const std::string extension = extensionOf(file);
  if (extension == "obj") return withoutSlashes(readText(file));
  if (extension != "dae") return std::nullopt;
  return withoutElements(withoutElements(readText(file), "library_effects"), "library_images");
}

}  // namespace ambient
