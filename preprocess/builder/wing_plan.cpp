#include "preprocess/builder/wing_plan.h"

#include <algorithm>
#include <cctype>
#include <functional>

#include "bullet_ambient/base/fnv1a.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/wings/wing_numbers.h"
#include "preprocess/mesh/wings/wing_search.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {
namespace {

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
    if (!file) return;
    scene_ = readSceneTriangles(file->file);
    scene_.mesh.vertices *= scale * file->scale;
    scene_.mesh.vertices = file->stretch.asDiagonal() * scene_.mesh.vertices;
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

  /// Adds triangles that no other wing has; each piece of at least kLeast of their area, and
  /// `least_share` of that of the mesh, is a wing. Returns how many wings it adds.
  int add(const GivenWing& given, const std::function<bool(std::size_t)>& belongs,
          double least_share = 0) {
    constexpr double kLeast = 0.1;
    DisjointSets pieces(is_taken_.size());
    std::vector<bool> chosen(is_taken_.size());
    for (std::size_t t = 0; t < chosen.size(); ++t) chosen[t] = !is_taken_[t] && belongs(t);
    for (const auto& [one, other] : pairs_)
      if (chosen[static_cast<std::size_t>(one.triangle)] &&
          chosen[static_cast<std::size_t>(other.triangle)])
        pieces.join(one.triangle, other.triangle);
    std::vector<double> areas(chosen.size());
    double whole = 0, all = 0;
    for (std::size_t t = 0; t < chosen.size(); ++t) {
      const double area = mesh_.twiceArea(static_cast<Eigen::Index>(t)).norm();
      all += area;
      if (!chosen[t]) continue;
      areas[static_cast<std::size_t>(pieces.find(static_cast<int>(t)))] += area;
      whole += area;
    }
    std::vector<std::uint8_t> labels(chosen.size());
    int added = 0;
    for (std::size_t t = 0; t < chosen.size(); ++t) {
      const auto piece = static_cast<std::size_t>(pieces.find(static_cast<int>(t)));
      if (!chosen[t] || areas[piece] < std::max(kLeast * whole, least_share * all)) continue;
      if (labels[piece] == 0) {
        labels[piece] = newWing(given);
        ++added;
      }
      plan_.labels[t] = labels[piece];
      is_taken_[t] = true;
    }
    return added;
  }

  bool isEmpty() const { return plan_.given.empty(); }

  /// The wings; none if one of them is the whole body, which has one law in any case, unless its
  /// sections are aerofoils.
  WingPlan result(bool sheet) && {
    if (plan_.given.empty()) return {};
    const bool is_whole = std::all_of(plan_.labels.begin(), plan_.labels.end(),
                                      [](std::uint8_t label) { return label == 1; });
    if (is_whole && std::abs(measureWings(mesh_, plan_.labels, sheet).front().wing.nose) != 1)
      return {};
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

/// Adds the nodes whose names say that they are wings, unless they are as small as the blades of an
/// airliner's fans; if there are none, what findWings() finds.
void addFound(const SourceTriangles& source, const TriangleMesh& mesh, bool sheet,
              PlanMaker& maker) {
  constexpr double kLeastNamed = 0.005;  // of the area of the body
  int named = 0;
  if (source.areKnown())
    for (const std::string name : {"wing*", "fin*", "blade*", "tail*", "rudder*", "keel*", "foil*"})
      named += maker.add(
          {name.substr(0, name.size() - 1), {}, {}, {}},
          [&](std::size_t t) { return isNamed(source.nodeOf(t), name); }, kLeastNamed);
  if (named > 0 || sheet) return;
  const std::vector<std::uint8_t> labels = findWings(mesh);
  const bool is_whole =
      std::all_of(labels.begin(), labels.end(), [](std::uint8_t label) { return label == 1; });
  if (labels.empty() || (is_whole && !maker.isEmpty())) return;
  for (int wing = 1; wing <= *std::max_element(labels.begin(), labels.end()); ++wing)
    maker.add({}, [&](std::size_t t) { return labels[t] == wing; });
}

/// The triangles of an entry of a list.
std::function<bool(std::size_t)> chosenBy(const ListedWing& entry, const TriangleMesh& mesh,
                                          const SourceTriangles& source, double scale,
                                          const std::string& file) {
  if (!entry.box.isEmpty()) {
    const Eigen::AlignedBox3d box(scale * entry.box.min(), scale * entry.box.max());
    return [&mesh, box](std::size_t t) {
      return box.contains(mesh.barycentre(static_cast<Eigen::Index>(t)));
    };
  }
  if (!source.areKnown()) raiseInputError(file, "names and numbers need a mesh file; use a box");
  if (!entry.node.empty())
    return [&](std::size_t t) { return isNamed(source.nodeOf(t), entry.node); };
  std::vector<bool> chosen(static_cast<std::size_t>(source.count()));
  for (const std::size_t number : entry.triangles) {
    if (number >= chosen.size())
      raiseInputError(file, "there is no triangle ", number, " among ", chosen.size());
    chosen[number] = true;
  }
  return [&source, chosen](std::size_t t) {
    return bool{chosen[static_cast<std::size_t>(source.of(t))]};
  };
}

std::optional<double> scaledBy(double scale, const std::optional<double>& length) {
  return length ? std::optional<double>(scale * *length) : std::nullopt;
}

}  // namespace

WingPlan planWings(const std::string& wanted, const TriangleMesh& mesh,
                   const ShapeDescription& shape, double scale) {
  if (wanted == "none") return {};
  PlanMaker maker(mesh, shape.source);
  const SourceTriangles source(shape, scale, mesh);
  bool wants_rest = wanted == "auto";
  if (!wants_rest) {
    const WingList list = readWingList(wanted);
    int number = 0;
    for (const ListedWing& entry : list.wings) {
      const GivenWing given{entry.name, scaledBy(scale, entry.span), scaledBy(scale, entry.chord),
                            entry.aspect};
      if (maker.add(given, chosenBy(entry, mesh, source, scale, wanted)) == 0)
        raiseInputError(wanted, "wings[", number, "] has no triangles of the mesh");
      ++number;
    }
    wants_rest = list.wants_rest;
  }
  if (wants_rest) addFound(source, mesh, isSheet(shape), maker);
  return std::move(maker).result(isSheet(shape));
}

std::string wingsText(const std::string& wanted) {
  if (wanted == "none") return "";
  return ", wings and sections " +
         (wanted == "auto" ? wanted : hashText(fnv1a64(readBytes(wanted))));
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
