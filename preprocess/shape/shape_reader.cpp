#include "preprocess/shape/shape_reader.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/json_schema.h"

namespace ambient {

namespace {

using nlohmann::json;
using Geometry = decltype(ShapeDescription::geometry);

struct ShapeSource {
  const json& shape;
  const std::filesystem::path& directory;
  const std::string& source;
};

template <int n>
Eigen::Matrix<double, n, 1> vectorOf(const json& array) {
  Eigen::Matrix<double, n, 1> vector;
  for (int k = 0; k < n; ++k) vector[k] = array[k].get<double>();
  return vector;
}

std::filesystem::path fileOf(const ShapeSource& from) {
  return (from.directory / from.shape["file"].get<std::string>()).lexically_normal();
}

double scaleOf(const ShapeSource& from) { return from.shape.value("scale", 1.0); }

/// The one of the keys that is given.
std::string requireOneOf(const ShapeSource& from, const std::vector<std::string>& keys) {
  std::string given, list;
  int count = 0;
  for (const std::string& key : keys) {
    list += (list.empty() ? "" : ", ") + key;
    if (!from.shape.contains(key)) continue;
    given = key;
    ++count;
  }
  if (count != 1) {
    raiseInputError(from.source, "shape ", from.shape["type"].dump(), " needs exactly one of ",
                    list, ", not ", count);
  }
  return given;
}

void refuseKey(const ShapeSource& from, const std::string& key, const std::string& why) {
  if (!from.shape.contains(key)) return;
  raiseInputError(from.source, "key \"", key, "\" in shape ", from.shape["type"].dump(), " ", why);
}

Geometry readBox(const ShapeSource& from) {
  if (requireOneOf(from, {"half_sizes", "size"}) == "size") {
    return Box{vectorOf<3>(from.shape["size"]) / 2};
  }
  return Box{vectorOf<3>(from.shape["half_sizes"])};
}

Geometry readSheet(const ShapeSource& from) {
  const std::string key = requireOneOf(from, {"size", "semi_axes", "file"});
  if (key == "file") {
    refuseKey(from, "faces", "has no meaning with \"file\": the mesh has its own");
    MeshFile mesh{fileOf(from), scaleOf(from)};
    mesh.sheet = true;
    return mesh;
  }
  refuseKey(from, "scale", "has no meaning without \"file\"");
  if (key == "size") return RectangleSheet{vectorOf<2>(from.shape["size"])};
  return EllipseSheet{vectorOf<2>(from.shape["semi_axes"])};
}

// One of the round shapes with a radius and a height.
template <class Shape>
Geometry readRound(const ShapeSource& from) {
  return Shape{from.shape["radius"].get<double>(), from.shape["height"].get<double>()};
}

Geometry readGeometry(const ShapeSource& from);

/// Reads a part of a compound. @throws std::runtime_error if it is not one of the solids that
/// follow from a few numbers, or its orientation has no direction
PlacedShape readPart(const ShapeSource& of, std::size_t index) {
  const json &part = of.shape["parts"][index], &shape = part["shape"];
  const std::string source = of.source + ".parts[" + std::to_string(index) + "]";
  for (const char* type : {"mesh", "fluid_body", "sheet", "compound"})
    if (shape["type"] == type) raiseInputError(source, "a part of a compound cannot be a ", type);
  PlacedShape placed{readGeometry({shape, of.directory, source}), RigidPose::Identity(), source};
  if (part.contains("position")) placed.pose.translation() = vectorOf<3>(part["position"]);
  if (part.contains("orientation")) {
    const json& q = part["orientation"];
    const Eigen::Quaterniond orientation(q[0].get<double>(), q[1].get<double>(), q[2].get<double>(),
                                         q[3].get<double>());
    if (!(orientation.norm() > 0)) raiseInputError(source, "its orientation has length 0");
    placed.pose.linear() = orientation.normalized().toRotationMatrix();
  }
  return placed;
}

Geometry readCompound(const ShapeSource& from) {
  Compound compound;
  for (std::size_t i = 0; i < from.shape["parts"].size(); ++i)
    compound.parts.push_back(readPart(from, i));
  return compound;
}

Geometry readGeometry(const ShapeSource& from) {
  static const std::map<std::string, std::function<Geometry(const ShapeSource&)>> readers{
      {"sphere", [](const auto& s) { return Sphere{s.shape["radius"].template get<double>()}; }},
      {"box", readBox},
      {"ellipsoid", [](const auto& s) { return Ellipsoid{vectorOf<3>(s.shape["semi_axes"])}; }},
      {"cylinder", readRound<Cylinder>},
      {"capsule", readRound<Capsule>},
      {"cone", readRound<Cone>},
      {"mesh",
       [](const auto& s) {
         MeshFile mesh{fileOf(s), scaleOf(s)};
         mesh.strict = s.shape.value("strict", false);
         return mesh;
       }},
      {"fluid_body", [](const auto& s) { return FluidBodyFile{fileOf(s)}; }},
      {"sheet", readSheet},
      {"compound", readCompound}};
  return readers.at(from.shape["type"].get<std::string>())(from);
}

/// "none", "auto", or the path of a list.
std::string wingsOf(const json& shape, const std::filesystem::path& directory) {
  const std::string wings = shape.value("wings", "none");
  if (wings == "none" || wings == "auto") return wings;
  return (directory / wings).lexically_normal().string();
}

}  // namespace

ShapeDescription readShape(const json& shape, const std::filesystem::path& directory,
                           const std::string& source) {
  static const JsonSchema schema(shapeSchema(), "the shape");
  schema.check(shape, source);
  ShapeDescription description;
  description.geometry = readGeometry({shape, directory, source});
  description.has_holds = shape.value("holds", "auto") == "auto";
  for (const json& tank : shape.value("tanks", json::array()))
    description.tanks.push_back((directory / tank.get<std::string>()).lexically_normal());
  for (const json& opening : shape.value("openings", json::array()))
    description.openings.push_back({vectorOf<3>(opening["place"]), vectorOf<3>(opening["normal"]),
                                    opening["area"].get<double>()});
  description.wings = wingsOf(shape, directory);
  description.faces = shape.value("faces", ShapeDescription::kDefaultFaces);
  description.text = shape.dump();
  description.source = source;
  return description;
}

ShapeDescription readShapeFile(const std::filesystem::path& file) {
  const json shape = parseJson(readBytes(file), file.string());
  return readShape(shape, file.parent_path(), file.string());
}

namespace {

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
    if (entry.contains("triangles")) {
      const json& triangles = entry["triangles"];
      const auto isNumber = [](const json& number) { return number.is_number_unsigned(); };
      if (!triangles.is_array() || !std::all_of(triangles.begin(), triangles.end(), isNumber))
        raiseInputError(file_, "triangles = ", triangles.dump(),
                        " must be a list of whole numbers from 0 on");
      wing.triangles = triangles.get<std::vector<std::size_t>>();
    }
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
