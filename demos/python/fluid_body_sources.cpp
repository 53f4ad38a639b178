#include "demos/python/fluid_body_sources.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "bullet_ambient/base/fnv1a.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
#include "preprocess/shape/json_text.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

/// Returns the fluid body from the cache if its provenance agrees, else the result of `build`.
template <class Build>
BuiltBody buildOnce(const SourceSettings& settings, const Provenance& provenance,
                    const Build& build) {
  BodyMaker maker(settings.cache, printReport);
  std::vector<std::string> warnings;
  const BodyMaker::Made made = maker.get(settings.name, provenance, [&](const auto& begin) {
    BuiltBody built = build(begin);
    warnings = std::move(built.warnings);
    return std::move(built.body);
  });
  maker.keep(made);
  return {*made.body, std::move(warnings)};
}

template <class Matrix>
std::string_view bytesOf(const Matrix& matrix) {
  return {reinterpret_cast<const char*>(matrix.data()),
          static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar)};
}

Provenance provenanceOf(const TriangleMesh& mesh, bool sheet, const SourceSettings& settings) {
  std::ostringstream text;
  text.precision(17);
  text << (sheet ? "sheet" : "body") << ", origin ";
  if (settings.origin)
    text << settings.origin->x() << "," << settings.origin->y() << "," << settings.origin->z();
  else
    text << "centre-of-volume";
  text << ", panels " << settings.flow.max_panels;
  if (settings.waterline_subdivisions != 0)
    text << ", waterline " << settings.waterline_subdivisions;
  if (settings.strict) text << ", strict";
  Provenance provenance;
  provenance.source = "arrays";
  provenance.source_hash =
      fnv1a64(std::string(bytesOf(mesh.vertices)) + std::string(bytesOf(mesh.triangles)));
  provenance.settings = text.str();
  provenance.generator = libraryVersion();
  return provenance;
}

}  // namespace

BuiltBody buildFromMesh(const TriangleMesh& mesh, bool sheet, const SourceSettings& settings) {
  BuildSettings build;
  static_cast<CommonBuildSettings&>(build) = settings;
  build.flow.sheet = sheet;
  build.provenance = provenanceOf(mesh, sheet, settings);
  return buildOnce(settings, build.provenance, [&](const auto& begin) -> BuiltBody {
    build.begin = begin;
    CheckedMesh checked = sheet
                              ? requireSound(checkMesh(mesh, settings.name, {true}), settings.name)
                              : makeBodyMesh(mesh, settings.name, settings.strict);
    build.cavities = checked.cavities;
    build.warn = [&](const std::string& text) { checked.warnings.push_back(text); };
    FluidBody body = makeFluidBody(checked.mesh, build);
    return {std::move(body), std::move(checked.warnings)};
  });
}

BuiltBody buildFromShape(const std::string& json, const fs::path& folder,
                         const SourceSettings& settings) {
  ShapeDescription shape = readShape(parseJson(json, settings.name), folder, settings.name);
  if (auto* mesh = std::get_if<MeshFile>(&shape.geometry))
    mesh->strict = mesh->strict || settings.strict;
  ShapeBuildSettings build;
  static_cast<CommonBuildSettings&>(build) = settings;
  if (std::holds_alternative<FluidBodyFile>(shape.geometry)) return buildShape(shape, build);
  return buildOnce(settings, describeShape(shape, build), [&](const auto& begin) {
    build.begin = begin;
    return buildShape(shape, build);
  });
}

}  // namespace ambient
