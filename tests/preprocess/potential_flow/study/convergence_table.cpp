#include "tests/preprocess/potential_flow/study/convergence_table.h"

#include <cmath>
#include <cstdio>
#include <vector>

#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "tests/preprocess/potential_flow/study/accuracy_case.h"
#include "tests/preprocess/potential_flow/study/known_added_mass.h"
#include "tests/preprocess/potential_flow/study/study_meshes.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/reference/sheet_added_mass.h"

namespace ambient::study {
namespace {

/// Meshes of one body from coarse to fine; each triangle is a panel.
struct Sequence {
  std::string name;
  bool sheet;
  std::vector<TriangleMesh> meshes;
  Vector6 exact;
};

Sequence smoothBody() {
  const Vector3 semi_axes(1, 1, 2);
  Sequence sequence{"spheroid 2 : 1", false, {}, reference::ellipsoidAddedMass(semi_axes)};
  const double volume = 8 * std::acos(-1.0) / 3;
  for (const int n : {4, 6, 9, 13})
    sequence.meshes.push_back(scaledToVolume(makeEllipsoidMesh(semi_axes, 20 * n * n), volume));
  return sequence;
}

Sequence uniformCube() {
  Sequence sequence{"cube, triangles of equal size", false, {}, cubeAddedMass().diagonal()};
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 12);
  for (int level = 0; level < 4; ++level) {
    mesh = divideTriangles(mesh, 4 * static_cast<int>(mesh.triangleCount()));
    sequence.meshes.push_back(mesh);
  }
  return sequence;
}

Sequence refinedCube() {
  Sequence sequence{
      "cube of 12 triangles, panels made by the solver", false, {}, cubeAddedMass().diagonal()};
  for (const int panels : {300, 1000, 2400, 4200})
    sequence.meshes.push_back(refineSurface(makeBoxMesh({1, 1, 1}, 12), false, panels));
  return sequence;
}

Sequence gradedCube() {
  Sequence sequence{
      "cube, triangles graded towards the edges", false, {}, cubeAddedMass().diagonal()};
  for (const int faces : {192, 432, 1200, 3072})
    sequence.meshes.push_back(makeBoxMesh({1, 1, 1}, faces));
  return sequence;
}

Sequence gradedSheet() {
  const reference::SheetAddedMass rectangle = reference::rectangleAddedMass(2);
  Vector6 exact = Vector6::Zero();
  exact[0] = rectangle.w_x;
  exact[1] = rectangle.w_y;
  exact[5] = rectangle.v_z;
  Sequence sequence{"rectangular sheet 2 : 1, graded towards the boundary", true, {}, exact};
  for (const int faces : {150, 400, 1200, 3600})
    sequence.meshes.push_back(makeRectangularSheetMesh(2, 1, faces));
  return sequence;
}

std::string orderText(double before, double after, double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", 2 * std::log(before / after) / std::log(ratio));
  return text;
}

std::string rowsOf(const Sequence& sequence) {
  std::string rows;
  AccuracyRow last;
  for (const TriangleMesh& mesh : sequence.meshes) {
    const Reference exact{sequence.exact.asDiagonal(), 0};
    AccuracyRow row =
        compareAddedMass(builtAddedMass(mesh, sequence.sheet, 0), exact, Symmetry::kThreeMirrors);
    row.panels = mesh.triangleCount();
    const double ratio = static_cast<double>(row.panels) / static_cast<double>(last.panels);
    const bool first = last.panels == 0;
    char line[256];
    std::snprintf(line, sizeof line, "| %s | %ld | %.1e | %s | %.1e | %s |\n",
                  sequence.name.c_str(), static_cast<long>(row.panels), row.rotation,
                  first ? "" : orderText(last.rotation, row.rotation, ratio).c_str(),
                  row.translation,
                  first ? "" : orderText(last.translation, row.translation, ratio).c_str());
    std::fputs(line, stdout);
    std::fflush(stdout);
    rows += line;
    last = row;
  }
  return rows;
}

}  // namespace

std::string convergenceTable() {
  const std::string head =
      "| body | panels | rotation | order | translation | order |\n|---|---|---|---|---|---|\n";
  std::fputs(head.c_str(), stdout);
  std::string table = head;
  for (const auto& make : {smoothBody, uniformCube, gradedCube, refinedCube, gradedSheet})
    table += rowsOf(make());
  return table;
}

}  // namespace ambient::study
