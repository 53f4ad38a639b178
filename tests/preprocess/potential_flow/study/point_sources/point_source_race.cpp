#include "tests/preprocess/potential_flow/study/point_sources/point_source_race.h"

#include <cstdio>

#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/shape/shape_mesh.h"
#include "tests/preprocess/potential_flow/study/accuracy_case.h"
#include "tests/preprocess/potential_flow/study/timed_added_mass.h"
#include "tests/reference/ellipsoid_added_mass.h"

namespace ambient::study {
namespace {

constexpr int kRaceTakes = 3;

}  // namespace

std::string pointSourceRace(const std::string& script) {
  std::string table =
      "| body | method | vertices | rotation | translation | processor | wall |\n"
      "|---|---|---|---|---|---|---|\n";
  std::fputs(table.c_str(), stdout);
  for (const double height : {1.0, 0.5, 0.1}) {
    const Vector3 semi_axes(1, 1, height);
    ShapeDescription shape;
    shape.geometry = Ellipsoid{semi_axes};
    shape.faces = 2900;
    const TriangleMesh mesh = makeShapeMesh(shape).mesh;
    const Reference exact{reference::ellipsoidAddedMass(semi_axes).asDiagonal(), 0};
    const auto add = [&](const char* method, const TimedAddedMass& row) {
      const AccuracyRow error = compareAddedMass(row.added_mass, exact, Symmetry::kThreeMirrors);
      char line[256];
      std::snprintf(line, sizeof line,
                    "| spheroid 1 : 1 : %g | %s | %ld | %.1e | %.1e | %.2f s | %.2f s |\n", height,
                    method, static_cast<long>(mesh.vertexCount()), error.rotation,
                    error.translation, row.processor_seconds, row.wall_seconds);
      std::fputs(line, stdout);
      std::fflush(stdout);
      table += line;
    };
    add("complete build, 2 threads",
        takeTime(kRaceTakes, [&] { return builtAddedMass(mesh, false, kDefaultPanels, 2); }));
    add("point sources, velocity at vertices", runPointSources(script, false, kRaceTakes, mesh));
    add("point sources, exact flux", runPointSources(script, true, kRaceTakes, mesh));
  }
  return table;
}

}  // namespace ambient::study
