#include "tests/preprocess/potential_flow/study/cost_curve.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "preprocess/shape/shape_mesh.h"
#include "tests/preprocess/potential_flow/study/accuracy_case.h"
#include "tests/preprocess/potential_flow/study/known_added_mass.h"
#include "tests/preprocess/potential_flow/study/study_meshes.h"
#include "tests/preprocess/potential_flow/study/timed_added_mass.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient::study {
namespace {

constexpr int kTakes = 2;
constexpr int kFewPanels = 1000;

/// A body with a known added mass, and its mesher by approximate number of faces.
struct Body {
  std::string name;
  Matrix6 exact;
  std::function<TriangleMesh(int)> mesh;
};

Body spheroid(const std::string& name, double height) {
  const Vector3 semi_axes(1, 1, height);
  return {name, reference::ellipsoidAddedMass(semi_axes).asDiagonal(), [semi_axes](int faces) {
            return scaledToVolume(makeEllipsoidMesh(semi_axes, faces),
                                  4 * kPi / 3 * semi_axes.prod());
          }};
}

Body torus() {
  return {"torus 2 : 1", matrixOf(reference::torusAddedMass()), [](int faces) {
            test::TorusShape shape;
            shape.along = shape.around = static_cast<int>(std::sqrt(faces / 2.0));
            return scaledToVolume(test::makeTorus(shape), 4 * kPi * kPi);
          }};
}

Body twistedEllipsoid() {
  const double volume = 4 * kPi / 3 * 1.2 * 0.6;
  return {
      "twisted ellipsoid", matrixOf(reference::TwistedEllipsoidAddedMass()), [volume](int faces) {
        return scaledToVolume(test::twisted(makeEllipsoidMesh({1.2, 0.6, 1}, faces), 1), volume);
      }};
}

Body cylinder() {
  return {"cylinder, L/D 1", matrixOf(reference::cylinderAddedMass()), [](int faces) {
            ShapeDescription shape;
            shape.geometry = Cylinder{1, 2};
            shape.faces = faces;
            return makeShapeMesh(shape).mesh;
          }};
}

Body cube() {
  return {"cube, equal triangles", cubeAddedMass(), [](int faces) {
            return divideTriangles(makeBoxMesh({1, 1, 1}, 12), faces);
          }};
}

/// Added mass of the mesh without corrections: each triangle is a panel.
Matrix6 plainAddedMass(const TriangleMesh& mesh) { return solvePotentialFlow(mesh).added_mass; }

}  // namespace

std::string costCurve(const std::string& script) {
  std::string csv = "case,method,faces,processor_seconds,error\n";
  for (const Body& body : {spheroid("spheroid 1 : 1/2", 0.5), spheroid("spheroid 1 : 1/10", 0.1),
                           twistedEllipsoid(), torus(), cylinder(), cube()})
    for (const int faces : {80, 320, 1280, 2880}) {
      const TriangleMesh mesh = body.mesh(faces);
      const auto add = [&](const char* method, const TimedAddedMass& result) {
        const AccuracyRow error =
            compareAddedMass(result.added_mass, {body.exact, 0}, Symmetry::kThreeMirrors);
        char line[160];
        std::snprintf(line, sizeof line, "\"%s\",\"%s\",%ld,%.4f,%.3e\n", body.name.c_str(), method,
                      static_cast<long>(mesh.triangleCount()), result.processor_seconds,
                      std::max(error.rotation, error.translation));
        std::fputs(line, stdout);
        std::fflush(stdout);
        csv += line;
      };
      add("build", takeTime(kTakes, [&] { return builtAddedMass(mesh, false, kDefaultPanels); }));
      add("build, 1000 panels",
          takeTime(kTakes, [&] { return builtAddedMass(mesh, false, kFewPanels); }));
      add("panels alone", takeTime(kTakes, [&] { return plainAddedMass(mesh); }));
      add("point sources", runPointSources(script, false, kTakes, mesh));
      add("point sources, exact flux", runPointSources(script, true, kTakes, mesh));
    }
  return csv;
}

}  // namespace ambient::study
