#include "preprocess/builder/wing_plan.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <nlohmann/json.hpp>

#include "preprocess/mesh/import/scene_triangles.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/wings/wing_numbers.h"
#include "preprocess/mesh/wings/wing_search.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using nlohmann::json;

std::string inSmallLetters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// True if a name is that of a pattern, whose last character may be * for any rest.
bool isNamed(const std::string& name, const std::string& pattern) {
  const std::string low = inSmallLetters(name), wanted = inSmallLetters(pattern);
  if (wanted.empty() || wanted.back() != '*') return low == wanted;
  return low.compare(0, wanted.size() - 1, wanted, 0, wanted.size() - 1) == 0;
}

/// Triangles of a shape's file, and which of them each triangle of its checked mesh is a part of.
class SourceTriangles {
 public:
  SourceTriangles(const ShapeDescription& shape, double scale, const TriangleMesh& mesh) {
    const auto* file = std::get_if<MeshFile>(&shape.geometry);
    const auto* sheet = std::get_if<MeshSheet>(&shape.geometry);
    if (!file && !sheet) return;
    scene_ = readSceneTriangles(file ? file->file : sheet->file);
    scene_.mesh.vertices *= scale * (file ? file->scale : sheet->scale);
    if (file) scene_.mesh.vertices = file->stretch.asDiagonal() * scene_.mesh.vertices;
    const TriangleTree tree(scene_.mesh);
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
      source_.push_back(tree.nearest(mesh.barycentre(t)));
  }

  bool areKnown() const { return !source_.empty(); }
  int count() const { return static_cast<int>(scene_.nodes.size()); }
  /// Triangle of the file that a triangle of the mesh is a part of.
  int of(std::size_t triangle) const { return source_[triangle]; }
  /// Name of the node of a triangle of the mesh; empty: none.
  std::string nodeOf(std::size_t triangle) const {
    const int node = scene_.nodes[static_cast<std::size_t>(of(triangle))];
    return node < 0 ? std::string() : scene_.names[static_cast<std::size_t>(node)];
  }

 private:
  SceneTriangles scene_;
  std::vector<int> source_;
};

/// Collects wings, each of triangles that hang together.
class PlanMaker {
 public:
  PlanMaker(const TriangleMesh& mesh, std::string source)
      : mesh_(mesh),
        source_(std::move(source)),
        is_taken_(static_cast<std::size_t>(mesh.triangleCount())) {
    plan_.labels.assign(is_taken_.size(), 0);
    for (const EdgePair& pair : edgePairs(computeMeshEdges(mesh))) pairs_.push_back(pair);
  }

  /// Adds triangles that no other wing has; each piece of at least kLeast of their area is a wing.
  /// Returns how many wings it adds.
  int add(const GivenWing& given, const std::function<bool(std::size_t)>& belongs) {
    constexpr double kLeast = 0.1;
    DisjointSets pieces(is_taken_.size());
    std::vector<bool> chosen(is_taken_.size());
    for (std::size_t t = 0; t < chosen.size(); ++t) chosen[t] = !is_taken_[t] && belongs(t);
    for (const auto& [one, other] : pairs_)
      if (chosen[static_cast<std::size_t>(one.triangle)] &&
          chosen[static_cast<std::size_t>(other.triangle)])
        pieces.join(one.triangle, other.triangle);
    std::vector<double> areas(chosen.size());
    double whole = 0;
    for (std::size_t t = 0; t < chosen.size(); ++t) {
      if (!chosen[t]) continue;
      const double area = mesh_.twiceArea(static_cast<Eigen::Index>(t)).norm();
      areas[static_cast<std::size_t>(pieces.find(static_cast<int>(t)))] += area;
      whole += area;
    }
    std::vector<std::uint8_t> labels(chosen.size());
    int added = 0;
    for (std::size_t t = 0; t < chosen.size(); ++t) {
      const auto piece = static_cast<std::size_t>(pieces.find(static_cast<int>(t)));
      if (!chosen[t] || areas[piece] < kLeast * whole) continue;
      if (labels[piece] == 0) {
        labels[piece] = newWing(given);
        ++added;
      }
      plan_.labels[t] = labels[piece];
      is_taken_[t] = true;
    }
    return added;
  }

  /// The wings; none if one of them is the whole body, which has one law in any case.
  WingPlan result() && {
    const bool is_whole = std::all_of(plan_.labels.begin(), plan_.labels.end(),
                                      [](std::uint8_t label) { return label == 1; });
    if (plan_.given.empty() || is_whole) return {};
    return std::move(plan_);
  }

 private:
  std::uint8_t newWing(const GivenWing& given) {
    if (plan_.given.size() == kMostWings)
      raiseInputError(source_, "there are more than ", kMostWings, " wings");
    plan_.given.push_back(given);
    return static_cast<std::uint8_t>(plan_.given.size());
  }

  const TriangleMesh& mesh_;
  std::string source_;
  std::vector<bool> is_taken_;
  std::vector<EdgePair> pairs_;
  WingPlan plan_;
};

/// Adds the nodes whose names say that they are wings; if there are none, what findWings() finds.
void addFound(const SourceTriangles& source, const TriangleMesh& mesh, bool sheet,
              PlanMaker& maker) {
  int named = 0;
  if (source.areKnown())
    for (const std::string name : {"wing*", "fin*", "blade*", "tail*", "rudder*", "keel*", "foil*"})
      named += maker.add({name.substr(0, name.size() - 1), {}, {}, {}},
                         [&](std::size_t t) { return isNamed(source.nodeOf(t), name); });
  if (named > 0 || sheet) return;
  const std::vector<std::uint8_t> labels = findWings(mesh);
  if (labels.empty()) return;
  for (int wing = 1; wing <= *std::max_element(labels.begin(), labels.end()); ++wing)
    maker.add({}, [&](std::size_t t) { return labels[t] == wing; });
}

/// Reads the wings that a JSON file lists.
class WingList {
 public:
  WingList(std::string file, const TriangleMesh& mesh, const SourceTriangles& source, double scale)
      : file_(std::move(file)),
        mesh_(mesh),
        source_(source),
        scale_(scale),
        list_(parseJson(readBytes(file_), file_)) {}

  void addTo(PlanMaker& maker) const {
    if (!list_.is_object() || !list_.contains("wings") || !list_["wings"].is_array())
      raiseInputError(file_, "must be an object with a list \"wings\"");
    requireKeys(list_, {"wings", "rest"});
    int number = 0;
    for (const json& entry : list_["wings"]) {
      const std::string place = "wings[" + std::to_string(number++) + "]";
      if (!entry.is_object()) raiseInputError(file_, place, " must be an object");
      requireKeys(entry, {"node", "box", "triangles", "name", "span", "chord", "aspect"});
      if (maker.add(givenIn(entry), chosenBy(entry, place)) == 0)
        raiseInputError(file_, place, " has no triangles of the mesh");
    }
  }
  /// True if nodes with the names of wings are wings, too.
  bool wantsRest() const {
    if (!list_.contains("rest")) return false;
    if (list_["rest"] != "auto" && list_["rest"] != "none")
      raiseInputError(file_, "rest = ", list_["rest"].dump(), " must be \"auto\" or \"none\"");
    return list_["rest"] == "auto";
  }

 private:
  using Choice = std::function<bool(std::size_t)>;

  void requireKeys(const json& object, const std::vector<std::string>& known) const {
    for (const auto& [key, value] : object.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        raiseInputError(file_, "unknown key \"", key, "\"");
  }
  std::string textIn(const json& entry, const char* key) const {
    if (!entry[key].is_string()) raiseInputError(file_, key, " must be a text");
    return entry[key].get<std::string>();
  }
  std::optional<double> numberIn(const json& entry, const char* key, double unit) const {
    if (!entry.contains(key)) return std::nullopt;
    const bool is_positive = entry[key].is_number() && entry[key].get<double>() > 0;
    if (!is_positive) raiseInputError(file_, key, " = ", entry[key].dump(), " must be above 0");
    return unit * entry[key].get<double>();
  }
  GivenWing givenIn(const json& entry) const {
    std::string name;
    if (entry.contains("node")) name = textIn(entry, "node");
    if (entry.contains("name")) name = textIn(entry, "name");
    return {name, numberIn(entry, "span", scale_), numberIn(entry, "chord", scale_),
            numberIn(entry, "aspect", 1)};
  }

  Choice chosenBy(const json& entry, const std::string& place) const {
    if (entry.contains("node") + entry.contains("box") + entry.contains("triangles") != 1)
      raiseInputError(file_, place, " must have one of node, box and triangles");
    if (entry.contains("box")) return inBox(entry["box"], place);
    if (!source_.areKnown()) raiseInputError(file_, place, " needs a mesh file; use a box");
    if (entry.contains("node")) {
      const std::string pattern = textIn(entry, "node");
      return [this, pattern](std::size_t t) { return isNamed(source_.nodeOf(t), pattern); };
    }
    return amongTriangles(entry["triangles"], place);
  }

  Choice inBox(const json& corners, const std::string& place) const {
    std::array<std::array<double, 3>, 2> c{};
    try {
      corners.get_to(c);
    } catch (const json::exception&) {
      raiseInputError(file_, place, ".box must be two corners of three numbers");
    }
    const auto corner = [&](std::size_t i) { return Eigen::Vector3d(c[i][0], c[i][1], c[i][2]); };
    Eigen::AlignedBox3d box;
    box.extend(scale_ * corner(0)).extend(scale_ * corner(1));
    return [this, box](std::size_t t) {
      return box.contains(mesh_.barycentre(static_cast<Eigen::Index>(t)));
    };
  }

  Choice amongTriangles(const json& numbers, const std::string& place) const {
    std::vector<bool> chosen(static_cast<std::size_t>(source_.count()));
    if (!numbers.is_array()) raiseInputError(file_, place, ".triangles must be a list of numbers");
    for (const json& number : numbers) {
      if (!number.is_number_unsigned() || number.get<std::size_t>() >= chosen.size())
        raiseInputError(file_, place, ": there is no triangle ", number.dump(), " among ",
                        chosen.size());
      chosen[number.get<std::size_t>()] = true;
    }
    return [this, chosen](std::size_t t) {
      return bool{chosen[static_cast<std::size_t>(source_.of(t))]};
    };
  }

  std::string file_;
  const TriangleMesh& mesh_;
  const SourceTriangles& source_;
  double scale_;
  json list_;
};

}  // namespace

WingPlan planWings(const std::string& wanted, const TriangleMesh& mesh,
                   const ShapeDescription& shape, double scale) {
  if (wanted == "none") return {};
  PlanMaker maker(mesh, shape.source);
  const SourceTriangles source(shape, scale, mesh);
  bool wants_rest = wanted == "auto";
  if (!wants_rest) {
    const WingList list(wanted, mesh, source, scale);
    list.addTo(maker);
    wants_rest = list.wantsRest();
  }
  if (wants_rest) addFound(source, mesh, isSheet(shape), maker);
  return std::move(maker).result();
}

void setWings(const WingPlan& plan, const TriangleMesh& mesh, std::vector<std::uint8_t> labels,
              bool sheet, FluidBody& body) {
  if (plan.given.empty()) return;
  const std::vector<MeasuredWing> measured = measureWings(mesh, labels, sheet);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    Wing wing = measured[i].wing;
    const GivenWing& given = plan.given[i];
    wing.name = given.name;
    wing.span = given.span.value_or(wing.span);
    wing.chord = given.chord.value_or(wing.chord);
    wing.aspect = given.aspect.value_or((wing.is_joined ? 2 : 1) * wing.span / wing.chord);
    body.wings.push_back(wing);
  }
  body.part_of_triangle = std::move(labels);
}

}  // namespace ambient
