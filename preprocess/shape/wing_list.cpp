#include "preprocess/shape/wing_list.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/json_schema.h"

namespace ambient {
namespace {

using nlohmann::json;

/// Reads entries of one file.
class WingReader {
 public:
  explicit WingReader(std::string file) : file_(std::move(file)) {}

  WingList read() const {
    const json list = parseJson(readBytes(file_), file_);
    if (!list.is_object() || !list.contains("wings") || !list["wings"].is_array())
      raiseInputError(file_, "must be an object with a list \"wings\"");
    requireKeys(list, {"wings", "rest"});
    WingList result;
    for (const json& entry : list["wings"]) result.wings.push_back(wingOf(entry));
    const std::string rest = list.value("rest", json("none")).dump();
    if (rest != "\"auto\"" && rest != "\"none\"")
      raiseInputError(file_, "rest = ", rest, " must be \"auto\" or \"none\"");
    result.wants_rest = rest == "\"auto\"";
    return result;
  }

 private:
  void requireKeys(const json& object, const std::vector<std::string>& known) const {
    for (const auto& [key, value] : object.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        raiseInputError(file_, "unknown key \"", key, "\"");
  }

  template <class Value>
  Value valueOf(const json& value, const char* key, const char* wanted) const {
    try {
      return value.get<Value>();
    } catch (const json::exception&) {
      raiseInputError(file_, key, " = ", value.dump(), " must be ", wanted);
    }
  }

  std::optional<double> sizeOf(const json& entry, const char* key) const {
    if (!entry.contains(key)) return std::nullopt;
    if (!entry[key].is_number() || !(entry[key].get<double>() > 0))
      raiseInputError(file_, key, " = ", entry[key].dump(), " must be above 0");
    return entry[key].get<double>();
  }

  ListedWing wingOf(const json& entry) const {
    if (!entry.is_object()) raiseInputError(file_, entry.dump(), " must be an object");
    requireKeys(entry, {"node", "box", "triangles", "name", "span", "chord", "aspect"});
    if (entry.contains("node") + entry.contains("box") + entry.contains("triangles") != 1)
      raiseInputError(file_, entry.dump(), " must have one of node, box and triangles");
    ListedWing wing;
    if (entry.contains("node"))
      wing.node = wing.name = valueOf<std::string>(entry["node"], "node", "a text");
    if (entry.contains("box"))
      for (const auto& c : valueOf<std::array<std::array<double, 3>, 2>>(
               entry["box"], "box", "two corners of three numbers"))
        wing.box.extend(Eigen::Vector3d(c[0], c[1], c[2]));
    if (entry.contains("triangles"))
      wing.triangles = valueOf<std::vector<std::size_t>>(entry["triangles"], "triangles",
                                                         "a list of numbers from 0 on");
    if (entry.contains("name")) wing.name = valueOf<std::string>(entry["name"], "name", "a text");
    wing.span = sizeOf(entry, "span");
    wing.chord = sizeOf(entry, "chord");
    wing.aspect = sizeOf(entry, "aspect");
    return wing;
  }

  std::string file_;
};

}  // namespace

WingList readWingList(const std::string& file) { return WingReader(file).read(); }

}  // namespace ambient
