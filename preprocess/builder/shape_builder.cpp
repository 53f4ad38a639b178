#include "preprocess/builder/shape_builder.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "bullet_ambient/base/fnv1a.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

// Below this the faces, not the model, decide about the loads on what is round.
constexpr Eigen::Index kCoarse = 100;

// Panels are cut from triangles and keep their aspect: an elliptic sheet of 1000 : 1 is 7 % off in
// rotation.
constexpr double kSkinny = 200;

/// Longest extent over the middle one.
double slendernessOf(const TriangleMesh& mesh) {
  Eigen::Vector3d extents = mesh.extents();
  std::sort(extents.begin(), extents.end());
  return extents[1] > 0 ? extents[2] / extents[1] : 1;
}

/// A solver that is asked for by name is used, known or not.
std::optional<KnownAddedMass> knownAddedMass(const ShapeDescription& shape,
                                             const ShapeBuildSettings& settings) {
  if (settings.flow.solver != FlowSolverKind::Automatic) return std::nullopt;
  auto known = factsOf(shape.geometry).added_mass(settings.scale);
  if (known && known->is_tabulated && !settings.tables) return std::nullopt;
  return known;
}

/// The triangle of largest aspect of those that panels are cut from.
TriangleQuality worstForPanels(const TriangleMesh& mesh, bool sheet, int max_panels) {
  const TriangleQuality worst = findWorstTriangles(mesh, 1).front();
  if (worst.aspect <= kSkinny) return worst;
  return findWorstTriangles(mergeFlatTriangles(mesh, sheet, max_panels), 1).front();
}

/// Begins like the messages about the shape's mesh.
std::ostringstream warningOf(const ShapeDescription& shape) {
  std::ostringstream text;
  text.precision(3);
  text << shape.source << ": ";
  return text;
}

/// True if the form law takes all of the surface as flat sides with edges, as they are.
bool isFlatSided(const FluidBody& body) {
  const std::vector<double>& sharpness = body.form.faces.sharpness;
  return std::all_of(sharpness.begin(), sharpness.end(), [](double s) { return s >= 1; });
}

void warnOfFaces(CheckedMesh& checked, const ShapeDescription& shape, const FluidBody& body) {
  const Eigen::Index faces = checked.mesh.triangleCount();
  if (faces >= kCoarse || isFlatSided(body)) return;
  std::ostringstream text = warningOf(shape);
  text << faces
       << " triangles are few for a round surface: loads may be off by a fifth; by the published "
          "law, which takes one sample of each, those in rotation by half";
  checked.warnings.push_back(text.str());
}

void warnOfPanels(CheckedMesh& checked, const ShapeDescription& shape, int max_panels) {
  std::ostringstream text = warningOf(shape);
  const TriangleQuality worst = worstForPanels(checked.mesh, isSheet(shape), max_panels);
  if (worst.aspect > kSkinny && !fileOf(shape).empty()) {
    text << "triangle " << worst.triangle << " at " << pointText(worst.barycentre) << " is "
         << worst.aspect << " times as long as high: if the body is not that thin there, the added "
         << "mass may be some per cent off (the report estimates its error)";
    checked.warnings.push_back(text.str());
  } else if (const double slenderness = slendernessOf(checked.mesh); slenderness > kSkinny) {
    text << "it is " << std::lround(slenderness)
         << " times as long as wide: the added mass may be some per cent off";
    checked.warnings.push_back(text.str());
  }
}

/// Describes what is done to the triangles of the shape's file; empty: there is no file.
std::string meshText(const ShapeDescription& shape) {
  const auto* mesh = std::get_if<MeshFile>(&shape.geometry);
  if (mesh == nullptr) return {};
  std::ostringstream text;
  text.precision(17);
  if (mesh->stand_in == MeshStandIn::kHull) text << ", hull";
  if (mesh->stand_in == MeshStandIn::kWrap) text << ", wrap " << mesh->wrap_size;
  if (mesh->strict) text << ", strict";
  if (mesh->stretch != Eigen::Vector3d(1, 1, 1)) text << ", stretch " << mesh->stretch.transpose();
  return text.str();
}

/// Whether a shape may have holds: its mesh is read, or put together of several.
bool mayHaveHolds(const ShapeDescription& shape) {
  const auto* mesh = std::get_if<MeshFile>(&shape.geometry);
  return (mesh != nullptr && !mesh->sheet && mesh->stand_in != MeshStandIn::kHull) ||
         std::holds_alternative<Compound>(shape.geometry);
}

/// The scale in the shape's own description.
double ownScale(const ShapeDescription& shape) {
  const auto* mesh = std::get_if<MeshFile>(&shape.geometry);
  return mesh ? mesh->scale : 1;
}

/// Wings that are asked for: by the settings, else by the shape.
const std::string& wingsOf(const ShapeDescription& shape, const ShapeBuildSettings& settings) {
  return settings.wings == "none" ? shape.wings : settings.wings;
}

HoldSearch searchFor(const ShapeDescription& shape, const ShapeBuildSettings& settings) {
  HoldSearch search = settings.holds;
  search.is_wanted = search.is_wanted && shape.has_holds;
  search.tank_scale = settings.scale * ownScale(shape);
  search.tanks.insert(search.tanks.end(), shape.tanks.begin(), shape.tanks.end());
  for (GivenOpening opening : shape.openings) {
    opening.place *= settings.scale;
    opening.area *= settings.scale * settings.scale;
    search.openings.push_back(opening);
  }
  return search;
}

/// Refuses tanks and openings of a shape that cannot have them.
void requireRoomFor(const HoldSearch& given, const ShapeDescription& shape) {
  if (mayHaveHolds(shape) || (given.tanks.empty() && given.openings.empty())) return;
  raiseInputError(shape.source, "a tank or an opening needs a closed mesh or a compound");
}

std::string settingsText(const ShapeDescription& shape, const ShapeBuildSettings& settings) {
  std::ostringstream text;
  text.precision(17);
  text << (isSheet(shape) ? "sheet" : "body") << meshText(shape) << ", scale " << settings.scale
       << ", origin ";
  if (settings.origin) {
    text << settings.origin->x() << "," << settings.origin->y() << "," << settings.origin->z();
  } else {
    text << "centre-of-volume";
  }
  text << ", faces " << settings.least_faces;
  if (mayHaveHolds(shape)) text << holdsText(searchFor(shape, settings));
  text << wingsText(wingsOf(shape, settings));
  if (settings.waterline_subdivisions > 0)
    text << ", waterline " << settings.waterline_subdivisions;
  if (const auto known = knownAddedMass(shape, settings)) {
    text << ", " << known->source;
    return text.str();
  }
  text << ", panels " << settings.flow.max_panels;
  if (settings.flow.solver == FlowSolverKind::Dense) text << ", dense";
  if (settings.flow.solver == FlowSolverKind::Hierarchical) text << ", hierarchical";
  return text.str();
}

BuiltBody readBody(const FluidBodyFile& shape, const ShapeBuildSettings& settings) {
  const std::string name = shape.file.string();
  if (settings.origin) raiseInputError(name, "a fluid body keeps its origin");
  if (settings.scale != 1) {
    raiseInputError(name, "scale = ", settings.scale, ": a fluid body keeps its size");
  }
  if (settings.waterline_subdivisions != 0)
    raiseInputError(name, "waterline subdivisions = ", settings.waterline_subdivisions,
                    ": a fluid body keeps the waterline table that it was built with");
  if (settings.wings != "none")
    raiseInputError(name, "wings = ", settings.wings, ": a fluid body keeps the wings that it has");
  return {readPrepared(shape.file), {}};
}

}  // namespace

Provenance describeShape(const ShapeDescription& shape, const ShapeBuildSettings& settings) {
  requireUsualExtents(shape.geometry, settings.scale, shape.source);
  const std::filesystem::path file = fileOf(shape);
  ShapeBuildSettings effective = settings;
  effective.scale *= ownScale(shape);
  Provenance provenance;
  provenance.source = file.empty() ? shape.text : file.filename().string();
  provenance.source_hash = fnv1a64(file.empty() ? shape.text : readBytes(file));
  provenance.settings = settingsText(shape, effective);
  provenance.generator = libraryVersion();
  return provenance;
}

BuiltBody buildShape(const ShapeDescription& shape, const ShapeBuildSettings& settings) {
  if (!std::isfinite(settings.scale) || settings.scale <= 0) {
    raiseInputError(shape.source, "scale = ", settings.scale, " is not positive and finite");
  }
  if (settings.flow.max_panels < 0 || settings.flow.max_panels > kMostDivisions) {
    raiseInputError(shape.source, "panels = ", settings.flow.max_panels,
                    " is not between 0 (no division) and ", kMostDivisions);
  }
  if (settings.least_faces < 0 || settings.least_faces > kMostDivisions) {
    raiseInputError(shape.source, "least faces = ", settings.least_faces,
                    " is not between 0 (no division) and ", kMostDivisions);
  }
  if (const auto* fluid_body = std::get_if<FluidBodyFile>(&shape.geometry)) {
    return readBody(*fluid_body, settings);
  }
  requireRoomFor(settings.holds, shape);
  if (settings.begin) settings.begin("reading and checking the mesh");
  CheckedMesh checked = makeShapeMesh(shape, settings.scale);
  const ShapeFacts facts = factsOf(shape.geometry);
  BuildSettings build;
  static_cast<CommonBuildSettings&>(build) = settings;
  build.source = shape.source;
  build.cavities = checked.cavities;
  if (mayHaveHolds(shape)) {
    build.holds = searchFor(shape, settings);
    const std::vector<std::string> lines = takeHolds(checked.mesh, build);
    checked.warnings.insert(checked.warnings.end(), lines.begin(), lines.end());
  }
  build.wings = planWings(wingsOf(shape, settings), checked.mesh, shape, settings.scale);
  if (const auto known = knownAddedMass(shape, settings)) {
    build.added_mass = known->added_mass;
    build.viscous_flow = facts.viscous_flow(settings.scale, known->added_mass);
    if (known->is_tabulated) {
      build.added_mass_parts = estimateParts(checked.mesh, known->added_mass);
    } else if (facts.sphere_radius == 0) {
      build.added_mass_parts =
          joinPanels(ellipsoidPanels(checked.mesh, settings.scale * facts.half_extents));
    }
  } else {
    warnOfPanels(checked, shape, settings.flow.max_panels);
  }
  build.flow.sheet = isSheet(shape);
  build.sphere_radius = settings.scale * facts.sphere_radius;
  build.provenance = describeShape(shape, settings);
  if (!fileOf(shape).empty())
    build.warn = [&](const std::string& text) { checked.warnings.push_back(text); };
  FluidBody body = makeFluidBody(checked.mesh, build);
  warnOfFaces(checked, shape, body);
  body.provenance.said = checked.warnings;
  return {std::move(body), checked.warnings};
}

}  // namespace ambient
