// The form law of docs/theory.md section 11 on meshes of few triangles and on the same meshes
// divided.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

constexpr int kFine = 5000;  // triangles of a divided mesh

/// A thin body: its mesh, and the added mass across it [m^3].
struct Blade {
  const char* name;
  TriangleMesh mesh;
  Vector3 added_mass;
  bool is_sheet = false;
};

TriangleMesh hullOf(const std::vector<Vector3>& corners) {
  Eigen::Matrix3Xd points(3, corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
    points.col(static_cast<Eigen::Index>(i)) = corners[i];
  return makeConvexHull(points, "hull");
}

TriangleMesh sheetOfTwoTriangles() {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, 1, 1, 0, 0, 0, 3, 3, 0, 0, 0, 0;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  return mesh;
}

/// A plate, a tapered fin with a sharp nose, a triangular blade with a blunt spine, a fin of
/// diamond section, and a sheet.
std::vector<Blade> blades() {
  return {
      {"plate", makeBoxMesh({0.5, 1.5, 0.015}, 12), {0.02, 0.05, 2}},
      {"wedge fin",
       hullOf({{0, 0, 0}, {1, 0, 0.04}, {1, 0, -0.04}, {0.5, 2, 0}, {1, 2, 0.02}, {1, 2, -0.02}}),
       {0.02, 0.01, 1}},
      {"delta blade",
       hullOf({{0, 0, 0}, {1.5, 0.7, 0}, {1.5, -0.7, 0}, {1.5, 0, 0.06}}),
       {0.02, 0.02, 0.5}},
      {"diamond fin",
       hullOf({{0.5, 0, 0},
               {-0.5, 0, 0},
               {0, 0, 0.04},
               {0, 0, -0.04},
               {0.5, 2, 0},
               {-0.5, 2, 0},
               {0, 2, 0.04},
               {0, 2, -0.04}}),
       {0.02, 0.01, 1.2}},
      {"sheet", sheetOfTwoTriangles(), {0, 0, 2}, true}};
}

FluidBody bodyOf(const Blade& blade, int least_faces) {
  BuildSettings settings;
  settings.name = blade.name;
  settings.least_faces = least_faces;
  settings.flow.sheet = blade.is_sheet;
  Matrix6 inertia = Matrix6::Zero();
  inertia.bottomRightCorner<3, 3>() = blade.added_mass.asDiagonal();
  settings.added_mass = inertia;
  return makeFluidBody(blade.mesh, settings);
}

std::shared_ptr<const SurfaceLoads> loadsOf(const FluidBody& body) {
  FlowSettings flow;
  flow.precision = LoadPrecision::kDouble;
  return makeSurfaceLoads(std::make_shared<FluidBody>(body), {1, 1e-6, {}, {}}, flow);
}

TEST(FormLawRefinement, KeepsTheNumbersOfTheShape) {
  for (const Blade& blade : blades()) {
    const FormShape coarse = formShapeOf(bodyOf(blade, 0)),
                    fine = formShapeOf(bodyOf(blade, kFine));
    EXPECT_GT(coarse.wing, 0.8) << blade.name;
    EXPECT_NEAR(coarse.wing, fine.wing, 1e-12) << blade.name;
    EXPECT_NEAR(coarse.edges, fine.edges, 1e-12) << blade.name;
    EXPECT_NEAR(coarse.aspect, fine.aspect, 1e-10) << blade.name;
    EXPECT_NEAR(coarse.chord, fine.chord, 1e-10) << blade.name;
    EXPECT_NEAR(std::abs(coarse.span.dot(fine.span)), 1, 1e-10) << blade.name;
  }
}

TEST(FormLawRefinement, LeavesAPlateItsAspectRatioAndChord) {
  const FormShape sheet = formShapeOf(bodyOf(blades().back(), 0));
  EXPECT_NEAR(sheet.aspect, 3, 1e-12);
  EXPECT_NEAR(sheet.chord, 1, 1e-12);
  // The rim of the plate adds to both second moments.
  const FormShape plate = formShapeOf(bodyOf(blades().front(), 0));
  EXPECT_NEAR(plate.aspect, 3, 0.1);
  EXPECT_NEAR(plate.chord, 1, 0.05);
}

// A per cent of the load, or of the mean of all loads where those on the sides cancel.
TEST(FormLawRefinement, KeepsForceAndMomentWithinAPercent) {
  test::Arbitrary arbitrary(76);
  for (const Blade& blade : blades()) {
    const auto coarse = loadsOf(bodyOf(blade, 0)), fine = loadsOf(bodyOf(blade, kFine));
    constexpr int kMotions = 200;
    std::vector<Wrench> found, expected;
    double force = 0, torque = 0;
    for (int i = 0; i < kMotions; ++i) {
      const Twist x = arbitrary.twist(i % 2 ? 1 : 0, 1);
      found.push_back(coarse->load(x));
      expected.push_back(fine->load(x));
      force += expected.back().force.norm() / kMotions;
      torque += expected.back().torque.norm() / kMotions;
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Wrench &a = found[i], &b = expected[i];
      EXPECT_LE((a.force - b.force).norm(), 0.01 * std::max(force, b.force.norm()))
          << blade.name << " " << i;
      EXPECT_LE((a.torque - b.torque).norm(), 0.01 * std::max(torque, b.torque.norm()))
          << blade.name << " " << i;
    }
  }
}

}  // namespace
}  // namespace ambient
