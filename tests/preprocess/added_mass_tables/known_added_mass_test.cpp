#include "preprocess/added_mass_tables/known_added_mass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/added_mass_tables/table_places.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/reference/body_added_mass.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

Matrix6 boxOf(double a, double b, double c) { return boxAddedMass({a, b, c}).value(); }

double relative(double value, double exact) { return std::abs(value / exact - 1); }

Matrix6 matrixOf(const reference::RevolutionAddedMass& K) {
  return RevolutionInertia{K.v_z, K.v_x, K.w_y, K.coupling}.matrix();
}

/// Compares relative to the largest entry of each block; tolerances from docs/accuracy.md.
void expectClose(const Matrix6& K, const Matrix6& exact, double tolerance = 3e-3) {
  for (const int block : {0, 3}) {
    const Matrix3 expected = exact.block<3, 3>(block, block);
    const Matrix3 change = K.block<3, 3>(block, block) - expected;
    EXPECT_LT(change.cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff(), tolerance);
  }
}

// Helsing and Perfekt 2013; the rotation has an uncertainty of 4e-4.
TEST(KnownAddedMass, Cube) {
  const Vector6 K = boxOf(1, 1, 1).diagonal();
  EXPECT_LT(relative(K[3], 8 * reference::cubeAddedMassCoefficient()), 2e-4);
  EXPECT_LT(relative(K[0], reference::cubeRotationalAddedMass()), 1e-3);
}

TEST(KnownAddedMass, RoundBodies) {
  expectClose(*cylinderAddedMass(1, 2), matrixOf(reference::cylinderAddedMass()), 2e-4);
  expectClose(*cylinderAddedMass(1, 0.2), matrixOf(reference::coinAddedMass()), 2e-4);
  expectClose(*capsuleAddedMass(1, 2), matrixOf(reference::capsuleAddedMass()), 2e-4);
}

// Added mass grows about linearly with the thickness t, with a logarithm: 2 K(t) - K(2t) has an
// error up to 1.6 t over the width.
TEST(KnownAddedMass, ThinPlatesAreSheets) {
  const auto plate = [](double length) {
    return [length](double t) { return boxOf(length / 2, 0.5, t / 2).diagonal().eval(); };
  };
  for (const int length : {1, 2, 4}) {
    const auto box = plate(length);
    const double t = length / 99.0;
    const Vector6 K = 2 * box(t) - box(2 * t);
    const reference::SheetAddedMass sheet = reference::rectangleAddedMass(length);
    EXPECT_LT(relative(K[5], sheet.v_z), 2 * t) << length;
    EXPECT_LT(relative(K[0], sheet.w_x), 2 * t) << length;
    EXPECT_LT(relative(K[1], sheet.w_y), 2 * t) << length;
  }
}

// Plane flow: 2 pi c^2 - 1 for a square of side 1, c its conformal radius (Schwarz-Christoffel); a
// circle has its area. The difference between two rods eliminates the ends.
TEST(KnownAddedMass, LongRodsHaveTheAddedMassOfTheirSection) {
  const double c = std::pow(std::tgamma(0.25), 2) / (4 * std::pow(kPi, 1.5));
  const double square = (boxOf(100, 1, 1)(4, 4) - boxOf(60, 1, 1)(4, 4)) / 80;
  EXPECT_LT(relative(square, 4 * (2 * kPi * c * c - 1)), 2e-3);
  const double circle =
      ((*cylinderAddedMass(1, 200))(3, 3) - (*cylinderAddedMass(1, 120))(3, 3)) / 80;
  EXPECT_LT(relative(circle, kPi), 1e-3);
  const double capsule =
      ((*capsuleAddedMass(1, 200))(3, 3) - (*capsuleAddedMass(1, 120))(3, 3)) / 80;
  EXPECT_LT(relative(capsule, kPi), 1e-3);
}

TEST(KnownAddedMass, OrderOfTheSidesIsOfNoImportance) {
  for (int i = 0; i < 50; ++i) {
    const double a = 1.3 + 0.1 * i, b = 0.4, c = 2.7 - 0.03 * i;
    const Matrix6 K = boxOf(a, b, c), turned = boxOf(b, c, a), mirrored = boxOf(b, a, c);
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, swapped = k == 2 ? 2 : 1 - k;
      EXPECT_EQ(turned(k, k), K(next, next));
      EXPECT_EQ(turned(3 + k, 3 + k), K(3 + next, 3 + next));
      EXPECT_EQ(mirrored(k, k), K(swapped, swapped));
      EXPECT_EQ(mirrored(3 + k, 3 + k), K(3 + swapped, 3 + swapped));
    }
  }
}

TEST(KnownAddedMass, WhatSymmetryForbidsIsZero) {
  const Matrix6 box = boxOf(1.3, 0.4, 2.7);
  const Matrix6 diagonal = box.diagonal().asDiagonal();
  EXPECT_EQ(box, diagonal);
  Matrix6 cone = *coneAddedMass(0.7, 1.1);
  EXPECT_EQ(cone, cone.transpose());
  EXPECT_EQ(cone(1, 3), -cone(0, 4));
  EXPECT_EQ(cone(0, 0), cone(1, 1));
  EXPECT_EQ(cone(3, 3), cone(4, 4));
  // The wide lower end carries more: under a push along x at the centre, this end lags behind.
  EXPECT_LT(cone(1, 3), 0);
  EXPECT_EQ(cone.row(2), cone.row(2) * 0);
  cone(1, 3) = cone(3, 1) = cone(0, 4) = cone(4, 0) = 0;
  const Matrix6 rest = cone.diagonal().asDiagonal();
  EXPECT_EQ(cone, rest);
}

TEST(KnownAddedMass, GrowsWithTheSizeToTheLastBit) {
  EXPECT_EQ(boxOf(2.6, 0.8, 5.4), scaleShape(boxOf(1.3, 0.4, 2.7), 2));
  EXPECT_EQ(*cylinderAddedMass(0.5, 1.5), scaleShape(*cylinderAddedMass(1, 3), 0.5));
  EXPECT_EQ(*coneAddedMass(0.5, 1.5, 0.1), scaleShape(*coneAddedMass(1, 3, 0.2), 0.5));
  expectClose(*capsuleAddedMass(0.5, 1.5), scaleShape(*capsuleAddedMass(1, 3), 0.5), 1e-14);
}

TEST(KnownAddedMass, EndsWhereTheTablesEnd) {
  EXPECT_TRUE(boxAddedMass({100, 1, 1}) && boxAddedMass({0.01, 1, 1}));
  EXPECT_FALSE(boxAddedMass({100.001, 1, 1}) || boxAddedMass({1, 20, 0.19}));
  EXPECT_TRUE(cylinderAddedMass(1, 200) && cylinderAddedMass(1, 0.02));
  EXPECT_FALSE(cylinderAddedMass(1, 200.01) || cylinderAddedMass(1, 0.0199));
  EXPECT_TRUE(capsuleAddedMass(1, 200) && capsuleAddedMass(1, 1e-3));
  EXPECT_FALSE(capsuleAddedMass(1, 200.01));
  EXPECT_TRUE(coneAddedMass(1, 200) && coneAddedMass(1, 0.02) && coneAddedMass(1, 2, 5.9));
  EXPECT_FALSE(coneAddedMass(1, 200.01) || coneAddedMass(1, 0.0199) || coneAddedMass(1, 2, 6.1));
}

// Ball: V/2 in translation and 0 in rotation: Lamb, art. 92.
TEST(KnownAddedMass, ShortCapsulesAreBalls) {
  const Vector6 K = capsuleAddedMass(1, 1e-3)->diagonal();
  for (int k = 3; k < 6; ++k) EXPECT_NEAR(K[k] / (2 * kPi / 3), 1, 2e-3);
  EXPECT_LT(K[0], 1e-5);
  EXPECT_GT(K[0], 0);
}

TEST(KnownAddedMass, IsPositiveAllOverTheTables) {
  for (double x = -1; x <= 1; x += 0.05) {
    const double height = 2 * std::pow(kLargestRatio, x);
    for (double share = 0; share < kLargestRounding; share += 0.05) {
      const double rounding = height / (1 + height) * share / (1 - share);
      const Matrix6 K = coneAddedMass(1, height, rounding).value();
      EXPECT_GT(K(1, 1) * K(3, 3), K(1, 3) * K(1, 3)) << height << " " << rounding;
      EXPECT_GT(K(5, 5), 0);
    }
    for (double y = 0; y <= 1; y += 0.05) {
      const double longest = std::pow(kLargestRatio, (x + 1) / 2);
      EXPECT_GT(boxOf(longest, std::pow(longest, y), 1).diagonal().minCoeff(), 0);
    }
    EXPECT_GT((*cylinderAddedMass(1, height))(0, 0), 0);
  }
}

/// Sizes: half sizes of a box; else radius, height and rounding. Added mass: diagonal of a box;
/// else v_z, v_x, w_y and the coupling. Solved by added_mass_tables.py.
struct SolvedShape {
  Vector3 sizes;
  std::array<double, 6> entries;
};

Matrix6 revolutionOf(const std::array<double, 6>& k) {
  return RevolutionInertia{k[0], k[1], k[2], k[3]}.matrix();
}

/// Expects the table's entries within a tolerance, over the largest entry of the block; the
/// coupling of round bodies within one of its own, over the mean of the entries that it couples.
void expectTabulated(const std::string& kind, const SolvedShape& shape, double tolerance,
                     double tolerance_of_coupling) {
  const auto& [s, k] = shape;
  SCOPED_TRACE(testing::Message() << kind << " " << s.transpose());
  if (kind == "box")
    return expectClose(boxAddedMass(s).value(),
                       Eigen::Map<const Vector6>(k.data()).asDiagonal().toDenseMatrix(), tolerance);
  const Matrix6 K = (kind == "cylinder"  ? cylinderAddedMass(s[0], s[1])
                     : kind == "capsule" ? capsuleAddedMass(s[0], s[1])
                                         : coneAddedMass(s[0], s[1], s[2]))
                        .value();
  const Matrix6 exact = revolutionOf(k);
  expectClose(K, exact, tolerance);
  EXPECT_LT(std::abs(K(1, 3) - exact(1, 3)),
            tolerance_of_coupling * std::sqrt(exact(1, 1) * exact(3, 3)));
}

// The largest residual is in the smallest entry of long boxes: noise of the solver.
TEST(KnownAddedMass, OfTheSamplesIsWhatTheTablesWereFittedTo) {
  std::ifstream file(AMBIENT_TABLE_SAMPLES);
  std::string line, kind;
  int count = 0;
  while (std::getline(file, line)) {
    if (line[0] == '#') continue;
    line.replace(line.find(':'), 1, " ");
    std::istringstream words(line);
    SolvedShape shape{};
    words >> kind >> shape.sizes[0] >> shape.sizes[1] >> shape.sizes[2];
    for (double& entry : shape.entries) words >> entry;
    // Rounding puts samples at the edges of a table outside.
    const double inwards = shape.sizes[1] > 2 * shape.sizes[0] ? 1 - 1e-9 : 1 + 1e-9;
    kind == "box" ? shape.sizes[0] /= 1 + 1e-9 : shape.sizes[1] *= inwards;
    if (kind == "cone") shape.sizes[2] *= 1 - 1e-6;
    expectTabulated(kind, shape, 2e-3, 1e-3);
    ++count;
  }
  EXPECT_EQ(count, 89 + 25 + 24 + 189);
}

TEST(KnownAddedMass, OfBoxesIsThatOfFineMeshes) {
  const SolvedShape shapes[] = {
      {{1, 2, 3}, {48.78569, 113.3663, 39.26611, 68.14498, 23.84663, 14.52922}},
      {{5, 1, 0.3}, {4.504939, 237.2251, 35.16471, 0.8257037, 4.86366, 35.44395}},
      {{1, 0.9, 0.04}, {0.4773614, 0.6240953, 0.008961752, 0.01976262, 0.02207941, 3.380307}},
      {{7, 8, 9}, {45544.8, 45962.19, 37939.15, 3067.712, 2538.641, 2166.562}},
      {{1, 60, 70}, {2287845, 9.435287e+08, 6.368172e+08, 1031372, 1147.233, 978.1773}},
  };
  for (const SolvedShape& box : shapes) {
    const Vector6 exact = Eigen::Map<const Vector6>(box.entries.data());
    const Vector6 K = boxAddedMass(box.sizes)->diagonal();
    for (int k = 0; k < 6; ++k) EXPECT_LT(relative(K[k], exact[k]), 1e-3) << box.sizes.transpose();
  }
}

TEST(KnownAddedMass, OfRoundBodiesIsThatOfTheirMeridian) {
  const std::pair<const char*, SolvedShape> shapes[] = {
      {"cylinder", {{1, 0.07, 0}, {2.873623, 0.01381118, 0.3885129, 0}}},
      {"cylinder", {{1, 1.3, 0}, {3.558635, 1.940504, 0.4478577, 0}}},
      {"cylinder", {{1, 9, 0}, {3.978149, 24.46011, 126.7541, 0}}},
      {"cylinder", {{1, 150, 0}, {4.117516, 467.0697, 860406, 0}}},
      {"capsule", {{1, 0.1, 0}, {2.130886, 2.314064, 0.003125992, 0}}},
      {"capsule", {{1, 3.3, 0}, {2.524652, 11.09305, 11.29893, 0}}},
      {"capsule", {{1, 70, 0}, {2.778951, 219.9267, 89832.23, 0}}},
      {"cone", {{1, 0.05, 0}, {2.63284, 0.001201871, 0.3542016, -0.01300129}}},
      {"cone", {{1, 0.7, 0}, {2.313066, 0.2040682, 0.3724113, -0.1768396}}},
      {"cone", {{1, 3, 0}, {2.034092, 2.007288, 1.91303, -1.509608}}},
      {"cone", {{1, 110, 0}, {2.038614, 113.1892, 133615, -3061.968}}},
      {"cone", {{1, 2, 0.04}, {2.388891, 1.349988, 0.9577851, -0.8359612}}},
      {"cone", {{1, 0.2, 0.3}, {5.834332, 0.7017707, 1.097492, -0.1563671}}},
      {"cone", {{1, 20, 0.5}, {6.090897, 64.72487, 2143.273, -186.0436}}},
      {"cone", {{1, 1.5, 2.5}, {88.56118, 78.22566, 33.4365, -34.0024}}},
  };
  for (const auto& [kind, shape] : shapes) expectTabulated(kind, shape, 3e-3, 3e-3);
}

TEST(ChebyshevSeries, IsTheSumOfItsTerms) {
  constexpr double kCoefficients[] = {1, 2, 3, 4, 5, 6};
  const ChebyshevSeries series{3, 2, kCoefficients}, of_x{3, 1, kCoefficients};
  for (const double x : {-1.0, -0.3, 0.0, 0.7, 1.0}) {
    for (const double y : {-1.0, 0.2, 1.0}) {
      const double expected = 1 + 2 * y + (3 + 4 * y) * x + (5 + 6 * y) * (2 * x * x - 1);
      EXPECT_NEAR(series(x, y), expected, 1e-14);
      EXPECT_NEAR(of_x(x, y), 1 + 2 * x + 3 * (2 * x * x - 1), 1e-14);
    }
  }
}

// The form law of docs/theory.md section 11 on meshes of few triangles and on the same meshes
// divided.

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
      {"sheet",
       makeTriangleMesh({{0, 0, 0}, {1, 0, 0}, {1, 3, 0}, {0, 3, 0}}, {{0, 1, 2}, {0, 2, 3}}),
       {0, 0, 2},
       true}};
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

/// Largest differences between the loads on two bodies over several motions, each relative to the
/// load, or to the mean of all loads where those on the sides cancel.
struct Difference {
  double force = 0, torque = 0;
};

Difference between(const FluidBody& body, const FluidBody& reference) {
  test::Arbitrary arbitrary(76);
  const auto found = loadsOf(body), expected = loadsOf(reference);
  constexpr int kMotions = 200;
  std::vector<Wrench> a, b;
  double force = 0, torque = 0;
  for (int i = 0; i < kMotions; ++i) {
    const Twist x = arbitrary.twist(i % 2 ? 1 : 0, 1);
    a.push_back(found->load(x));
    b.push_back(expected->load(x));
    force += b.back().force.norm() / kMotions;
    torque += b.back().torque.norm() / kMotions;
  }
  Difference largest;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double scale = std::max(force, b[i].force.norm());
    const double torque_scale = std::max(torque, b[i].torque.norm());
    largest.force = std::max(largest.force, (a[i].force - b[i].force).norm() / scale);
    largest.torque = std::max(largest.torque, (a[i].torque - b[i].torque).norm() / torque_scale);
  }
  return largest;
}

/// Prism, frustum or cone of n sides about z, of height 1.
Blade bodyOfSides(const char* name, int sides, double lower, double upper) {
  std::vector<Vector3> corners;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * i / sides;
    corners.emplace_back(lower * std::cos(angle), lower * std::sin(angle), -0.5);
    if (upper > 0) corners.emplace_back(upper * std::cos(angle), upper * std::sin(angle), 0.5);
  }
  if (upper == 0) corners.emplace_back(0, 0, 0.5);
  const double mass = lower * lower;
  return {name, hullOf(corners), {1.2 * mass, 1.2 * mass, mass}};
}

std::vector<Blade> bodiesOfSides() {
  std::vector<Blade> all = blades();
  all.push_back({"box", makeBoxMesh({0.5, 1, 1.5}, 12), {3, 2, 1.5}});
  all.push_back({"octahedron",
                 hullOf({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}),
                 {0.5, 0.5, 0.5}});
  all.push_back(bodyOfSides("prism of 3", 3, 0.5, 0.5));
  all.push_back(bodyOfSides("prism of 6", 6, 0.5, 0.5));
  all.push_back(bodyOfSides("rod of 8", 8, 0.1, 0.1));
  all.push_back(bodyOfSides("prism of 9", 9, 0.5, 0.5));
  all.push_back(bodyOfSides("prism of 12", 12, 0.5, 0.5));
  all.push_back(bodyOfSides("prism of 16", 16, 0.5, 0.5));
  all.push_back(bodyOfSides("rod of 24", 24, 0.05, 0.05));
  all.push_back(bodyOfSides("disc of 24", 24, 5, 5));
  all.push_back(bodyOfSides("prism of 48", 48, 0.5, 0.5));
  all.push_back(bodyOfSides("cone of 4", 4, 0.5, 0));
  all.push_back(bodyOfSides("cone of 8", 8, 0.5, 0));
  all.push_back(bodyOfSides("cone of 16", 16, 0.5, 0));
  all.push_back(bodyOfSides("frustum of 10", 10, 0.5, 0.3));
  all.push_back(bodyOfSides("frustum of 11", 11, 0.5, 0.1));
  return all;
}

TEST(FormLawRefinement, KeepsForceAndMomentWithinAPercent) {
  for (const Blade& blade : bodiesOfSides()) {
    const Difference most = between(bodyOf(blade, 0), bodyOf(blade, kFine));
    EXPECT_LE(most.force, 0.01) << blade.name;
    EXPECT_LE(most.torque, 0.01) << blade.name;
  }
}

/// Cuts each triangle into four at the middles of its edges.
TriangleMesh halved(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> places;
  std::vector<Eigen::Vector3i> triangles;
  std::map<std::pair<int, int>, int> middles;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) places.push_back(mesh.vertices.col(v));
  const auto middle = [&](int a, int b) {
    const auto [entry, is_new] =
        middles.insert({std::minmax({a, b}), static_cast<int>(places.size())});
    if (is_new) places.push_back((mesh.vertices.col(a) + mesh.vertices.col(b)) / 2);
    return entry->second;
  };
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const int a = mesh.triangles(0, t), b = mesh.triangles(1, t), c = mesh.triangles(2, t);
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Eigen::Vector3i& part : {Eigen::Vector3i(a, ab, ca), Eigen::Vector3i(ab, b, bc),
                                        Eigen::Vector3i(ca, bc, c), Eigen::Vector3i(ab, bc, ca)})
      triangles.push_back(part);
  }
  return makeTriangleMesh(places, triangles);
}

/// The mesh as files in single precision have it.
TriangleMesh rounded(TriangleMesh mesh) {
  mesh.vertices = mesh.vertices.cast<float>().cast<double>();
  return mesh;
}

TEST(FormLawRefinement, ByHalvedEdgesKeepsForceAndMoment) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  for (Blade blade : bodiesOfSides()) {
    blade.mesh.vertices = turn * blade.mesh.vertices;
    const FluidBody coarse = bodyOf(blade, 0);
    constexpr int kMost = 4000;  // triangles: the time that this takes
    for (int times = 1; times <= 3 && 4 * blade.mesh.triangleCount() <= kMost; ++times) {
      blade.mesh = halved(blade.mesh);
      const Difference most = between(bodyOf(blade, 0), coarse);
      EXPECT_LE(most.force, 0.01) << blade.name << " halved " << times << " times";
      EXPECT_LE(most.torque, 0.01) << blade.name << " halved " << times << " times";
    }
    blade.mesh = rounded(blade.mesh);
    const Difference most = between(bodyOf(blade, 0), coarse);
    EXPECT_LE(most.force, 0.01) << blade.name << " in single precision";
    EXPECT_LE(most.torque, 0.01) << blade.name << " in single precision";
  }
}

}  // namespace
}  // namespace ambient
