#include "preprocess/builder/fluid_body_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/resistance/stokes_resistance.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/reference/body_added_mass.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

// Relative error with lengths in units of the body: all entries of K are comparable.
double relativeError(const Matrix6& a, const Matrix6& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TriangleMesh cone() { return makeConeMesh(0.5, 1.2, 300); }

FluidBody build(const TriangleMesh& mesh, BuildSettings settings = {}) {
  settings.name = "thing";
  return makeFluidBody(mesh, settings);
}

BuiltBody buildText(const std::string& shape, const ShapeBuildSettings& settings = {}) {
  return buildShape(readShape(nlohmann::json::parse(shape), "", "shape.json"), settings);
}

TEST(FluidBodyBuilder, BodiesSatisfyTheChecksOfTheFile) {
  checkFluidBody(build(cone()), "cone");
  BuildSettings sheet;
  sheet.flow.sheet = true;
  checkFluidBody(build(makeRectangularSheetMesh(1, 2, 200), sheet), "sheet");
}

TEST(FluidBodyBuilder, FillsTheViscousFormFromTheSolvedFlow) {
  const Vector3 semi_axes(1, 0.5, 0.5);
  BuildSettings settings;
  settings.origin = Vector3(0.3, 0, 0);
  const FluidBody body = build(makeEllipsoidMesh(semi_axes, 1280), settings);
  const ViscousForm& form = body.viscous;
  EXPECT_LT((form.centre_of_reaction - Vector3(-0.3, 0, 0)).norm(), 1e-3);
  const Vector6 R = shiftOrigin(form.resistance, form.centre_of_reaction).diagonal(),
                exact = ellipsoidResistance(semi_axes);
  EXPECT_LT(((R - exact).array() / exact.array()).abs().maxCoeff(), 0.01);
  EXPECT_EQ(form.separation.smooth_base, Vector3(1, 1, 1));
  EXPECT_NEAR(form.separation.ways[0].wake_laminar / 0.9245, 1, 0.04);
  EXPECT_NEAR(form.surface.frontal[0] / (kPi / 4), 1, 0.02);
  EXPECT_FALSE(form.is_primitive);
}

TEST(FluidBodyBuilder, OfASheetSeparationIsByEdges) {
  BuildSettings settings;
  settings.flow.sheet = true;
  const ViscousForm form = build(makeRectangularSheetMesh(1, 2, 200), settings).viscous;
  EXPECT_EQ(form.separation.smooth_base, Vector3::Zero());
  EXPECT_EQ(form.sharp_share, 1);
  EXPECT_NEAR(form.surface.diameter, std::sqrt(4 / kPi), 1e-12);
  EXPECT_GT(form.resistance(5, 5), form.resistance(4, 4));
}

TEST(FluidBodyBuilder, OriginIsTheCentreOfVolumeByDefault) {
  const Eigen::Vector3d far(3, -2, 5);
  const FluidBody body = build(moved(cone(), far));
  EXPECT_EQ(body.centre_of_volume, Vector3::Zero());
  EXPECT_EQ(body.uniform_mass.centre, Vector3::Zero());
  // Centre of volume: a quarter of the height above the base at -0.6, up to the facets.
  EXPECT_NEAR(body.origin.z(), 5 - 0.6 + 0.3, 2e-3);
  const Vector3 apex = far + Vector3(0, 0, 0.6) - body.origin;
  EXPECT_LT(
      (Vector3(body.surface.vertices[0], body.surface.vertices[1], body.surface.vertices[2]) - apex)
          .norm(),
      1e-15);
}

TEST(FluidBodyBuilder, AnotherOriginShiftsEverything) {
  const FluidBody centred = build(cone());
  BuildSettings settings;
  settings.origin = Eigen::Vector3d(0.1, -0.2, 0.3);
  const FluidBody shifted = build(cone(), settings);
  const Vector3 d = *settings.origin - centred.origin;
  EXPECT_EQ(shifted.origin, *settings.origin);
  EXPECT_LT((shifted.centre_of_volume + d).norm(), 1e-15);
  EXPECT_LT((shifted.surface_mass.centre + d - centred.surface_mass.centre).norm(), 1e-15);
  EXPECT_LT((shifted.faces.centroid(7) + d - centred.faces.centroid(7)).norm(), 1e-15);
  EXPECT_LT(relativeError(shifted.added_mass, shiftOrigin(centred.added_mass, d)), 1e-10);
  EXPECT_EQ(shifted.uniform_mass.inertia, centred.uniform_mass.inertia);
}

TEST(FluidBodyBuilder, FacesCloseTheSurface) {
  const FluidBody body = build(cone());
  Vector3 area_vector = Vector3::Zero();
  double area = 0, volume = 0;
  for (std::size_t i = 0; i < body.faces.size(); ++i) {
    area_vector += body.faces.area[i] * body.faces.normal(i);
    volume += body.faces.area[i] * body.faces.normal(i).dot(body.faces.centroid(i)) / 3;
    area += body.faces.area[i];
  }
  EXPECT_LT(area_vector.norm(), 1e-15 * 10);
  EXPECT_NEAR(volume / body.volume, 1, 1e-13);
  EXPECT_NEAR(area / body.area, 1, 1e-13);
}

TEST(FluidBodyBuilder, TwoTrianglesAreASheet) {
  const TriangleMesh square =
      makeTriangleMesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  BuildSettings settings;
  settings.name = "square";
  settings.flow.sheet = true;
  settings.flow.max_panels = 1000;
  const FluidBody sheet = makeFluidBody(square, settings);
  EXPECT_EQ(sheet.faces.size(), 4u);
  const reference::SheetAddedMass exact = reference::rectangleAddedMass(1);
  // Measured 6e-4 and 3e-4.
  EXPECT_NEAR(sheet.added_mass(0, 0) / exact.w_x, 1, 1e-3);
  EXPECT_NEAR(sheet.added_mass(5, 5) / exact.v_z, 1, 5e-4);
  settings.flow.max_panels = 32;  // coarser: no interior vertex
  EXPECT_NEAR(makeFluidBody(square, settings).added_mass(5, 5) / exact.v_z, 1, 0.2);
}

TEST(FluidBodyBuilder, SheetsHaveTwoSidesAndNoVolume) {
  BuildSettings settings;
  settings.flow.sheet = true;
  const TriangleMesh mesh = makeRectangularSheetMesh(0.4, 0.3, 200);
  const FluidBody sheet = build(mesh, settings);
  const auto count = static_cast<std::size_t>(mesh.triangleCount());
  EXPECT_EQ(sheet.volume, 0);
  EXPECT_NEAR(sheet.area, 2 * 0.4 * 0.3, 1e-15);
  ASSERT_EQ(sheet.faces.size(), 2 * count);
  EXPECT_EQ(sheet.surface.triangles.size(), 3 * count);
  EXPECT_EQ(sheet.faces.normal(0), Vector3(0, 0, 1));
  EXPECT_EQ(sheet.faces.normal(count), Vector3(0, 0, -1));
  EXPECT_EQ(sheet.faces.centroid(count + 5), sheet.faces.centroid(5));
  // Motions within the sheet's plane move no fluid.
  EXPECT_LT(sheet.added_mass.block(2, 2, 3, 3).norm(), 1e-14 * sheet.added_mass(5, 5));
}

TEST(FluidBodyBuilder, MeshesBeyondTheRangeOfADoubleAreRefused) {
  TriangleMesh mesh = makeEllipsoidMesh({1, 1, 1}, 80);
  for (const double size : {1e-10, 1e10, 1e100, std::numeric_limits<double>::infinity()}) {
    TriangleMesh scaled = mesh;
    scaled.vertices *= size;
    const std::string message = messageOf([&] { build(scaled); });
    EXPECT_EQ(message.find("thing: the diagonal of its bounding box is "), 0u) << message;
  }
}

// Lamb, Hydrodynamics: sphere V/2 per axis, nothing in rotation.
TEST(ShapeBuilder, SphereHasHalfItsVolumeAsAddedMass) {
  const std::string text = R"({"type":"sphere","radius":0.5})";
  const BuiltBody sphere = buildText(text);
  const double volume = kPi / 6;
  EXPECT_TRUE(sphere.warnings.empty());
  EXPECT_NEAR(sphere.body.volume / volume, 1, 1e-13);
  Matrix6 expected = Matrix6::Zero();
  expected.bottomRightCorner<3, 3>() = volume / 2 * Matrix3::Identity();
  EXPECT_LT(relativeError(sphere.body.added_mass, expected), 1e-14);
  ShapeBuildSettings solved;
  solved.flow.solver = FlowSolverKind::Dense;
  const double discretisation = relativeError(buildText(text, solved).body.added_mass, expected);
  EXPECT_GT(discretisation, 1e-9);
  EXPECT_LT(discretisation, 3e-5);  // at 1280 faces, measured 1e-5
}

TEST(ShapeBuilder, EllipsoidsHaveTheirClosedFormWhereverTheOriginIs) {
  ShapeBuildSettings settings;
  settings.scale = 2;
  settings.origin = Eigen::Vector3d(0.3, -0.2, 0.1);
  const FluidBody body =
      buildText(R"({"type":"ellipsoid","semi_axes":[0.5,0.4,0.1],"faces":320})", settings).body;
  const Matrix6 K = ellipsoidAddedMass({1, 0.8, 0.2}).asDiagonal();
  EXPECT_LT(relativeError(body.added_mass, shiftOrigin(K, *settings.origin)), 1e-14);
  EXPECT_EQ(body.provenance.settings.substr(body.provenance.settings.rfind(',')), ", closed form");
  checkFluidBody(body, "ellipsoid");
}

// A cavity does not change the flow outside, only the uniform mass.
TEST(FluidBodyBuilder, CavitiesMatterToTheUniformMassOnly) {
  const TriangleMesh outside = makeBoxMesh({1, 2, 3}, 200);
  const TriangleMesh hole = moved(makeBoxMesh({0.5, 0.5, 0.5}, 48), {0.2, 0, 0});
  BuildSettings settings;
  settings.added_mass = Matrix6::Identity();
  const FluidBody solid = build(outside, settings);
  settings.cavities = insideOut(hole);
  const FluidBody hollow = build(outside, settings);
  EXPECT_EQ(hollow.volume, solid.volume);
  EXPECT_EQ(hollow.faces.size(), solid.faces.size());
  EXPECT_EQ(hollow.centre_of_volume, solid.centre_of_volume);
  EXPECT_EQ(hollow.surface_mass.inertia, solid.surface_mass.inertia);
  // Mass 48, less 1 at 0.2 along x.
  EXPECT_NEAR(hollow.uniform_mass.centre.x(), -0.2 / 47, 1e-12);
  const double inertia = (48 * (4 + 9) / 3.0 - (0.25 + 0.25) / 3) / 47;
  EXPECT_NEAR(hollow.uniform_mass.inertia(0, 0), inertia, 1e-12);
  checkFluidBody(hollow, "hollow");
}

TEST(ShapeBuilder, OnlyASphereIsMarkedAsOne) {
  EXPECT_EQ(buildText(R"({"type":"sphere","radius":0.5,"faces":80})").body.sphere_radius, 0.5);
  EXPECT_EQ(
      buildText(R"({"type":"capsule","radius":0.5,"height":1,"faces":80})").body.sphere_radius, 0);
}

TEST(ShapeBuilder, ProvenanceNamesTheFileAndHashesItsBytes) {
  const TemporaryFolder folder;
  const std::string text = objText(cone());
  writeText(folder / "c.obj", text);
  ShapeDescription shape;
  shape.geometry = MeshFile{folder / "c.obj", 1};
  shape.source = "c.obj";
  ShapeBuildSettings settings;
  settings.name = "c";
  settings.scale = 0.5;
  const FluidBody body = buildShape(shape, settings).body;
  EXPECT_EQ(body.name, "c");
  EXPECT_EQ(body.provenance.source, "c.obj");
  EXPECT_EQ(body.provenance.source_hash, fnv1a64(text));
  EXPECT_EQ(body.provenance.settings,
            "body, scale 0.5, origin centre-of-volume, faces 0, holds auto, panels 4200");
  EXPECT_EQ(body.provenance.generator.substr(0, 15), "bullet_ambient ");
  EXPECT_NEAR(body.volume, kPi * 0.0625 * 0.2, 0.02 * body.volume);
  const FluidBody ball = buildText(R"({"type":"sphere", "radius":1, "faces":80})").body;
  EXPECT_EQ(ball.provenance.source, R"({"faces":80,"radius":1,"type":"sphere"})");
  EXPECT_EQ(ball.provenance.source_hash, fnv1a64(ball.provenance.source));
}

TEST(ShapeBuilder, CoarseMeshesAreWarnedAbout) {
  const BuiltBody round = buildText(R"({"type":"ellipsoid","semi_axes":[1,1,0.9],"faces":80})");
  ASSERT_EQ(round.warnings.size(), 1u);
  EXPECT_EQ(round.warnings[0].find("shape.json: 80 triangles are few"), 0u) << round.warnings[0];
  const BuiltBody box = buildText(R"({"type":"box","size":[1,0.7,0.5],"faces":12})");
  EXPECT_TRUE(box.warnings.empty()) << "flat sides are taken as they are";
  const BuiltBody ball = buildText(R"({"type":"sphere","radius":1,"faces":80})");
  EXPECT_TRUE(ball.warnings.empty()) << "loads on balls have a closed form";
}

TEST(ShapeBuilder, SkinnyTrianglesOfFilesAreWarnedAbout) {
  const TemporaryFolder folder;
  ShapeDescription shape;
  shape.geometry = MeshFile{folder.path() / "box.obj"};
  shape.source = "box.obj";
  ShapeBuildSettings settings;
  settings.flow.max_panels = 0;
  const auto warningsOf = [&](double thickness) {
    writeText(folder.path() / "box.obj", objText(makeBoxMesh({1, 1, thickness}, 200)));
    return buildShape(shape, settings).warnings;
  };
  EXPECT_TRUE(warningsOf(0.1).empty());
  const std::vector<std::string> warnings = warningsOf(0.0005);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(" times as long as high"), std::string::npos) << warnings[0];
}

TEST(ShapeBuilder, FluidBodiesAreReadAsTheyAre) {
  const TemporaryFolder folder;
  const FluidBody body = build(cone());
  writeFluidBody(body, folder / "c.ambient");
  ShapeDescription shape;
  shape.geometry = FluidBodyFile{folder / "c.ambient"};
  EXPECT_EQ(encodeFluidBody(buildShape(shape, {}).body, "read"), encodeFluidBody(body, "built"));
  ShapeBuildSettings settings;
  settings.scale = 2;
  EXPECT_EQ(messageOf([&] { buildShape(shape, settings); }),
            (folder / "c.ambient").string() + ": scale = 2: a fluid body keeps its size");
}

ShapeDescription describe(decltype(ShapeDescription::geometry) geometry) {
  ShapeDescription shape;
  shape.geometry = std::move(geometry);
  shape.faces = 400;
  shape.source = shape.text = "shape";
  return shape;
}

std::string lastSetting(const Provenance& provenance) {
  return provenance.settings.substr(provenance.settings.rfind(", ") + 2);
}

/// A solver would need more memory than that.
ShapeBuildSettings withoutMemory() {
  ShapeBuildSettings settings;
  settings.flow.max_panels = 100000;
  settings.flow.memory_limit = 1;
  return settings;
}

TEST(KnownShape, SimpleShapesAreBuiltWithoutASolver) {
  ShapeBuildSettings settings = withoutMemory();
  settings.scale = 0.5;
  const auto built = [&](auto geometry) { return buildShape(describe(geometry), settings).body; };
  EXPECT_EQ(built(Box{{2, 3, 4}}).added_mass, boxAddedMass({1, 1.5, 2}).value());
  EXPECT_EQ(built(Cylinder{2, 6}).added_mass, cylinderAddedMass(1, 3).value());
  EXPECT_EQ(built(Capsule{2, 6}).added_mass, capsuleAddedMass(1, 3).value());
  const FluidBody cone = built(Cone{2, 6});
  // About the centre of volume, a quarter of the height above the base.
  EXPECT_NEAR(cone.origin.z(), -0.75, 1e-3);
  EXPECT_EQ(cone.added_mass, shiftOrigin(*coneAddedMass(1, 3), cone.origin));
  EXPECT_EQ(cone.added_mass, cone.added_mass.transpose());
  EXPECT_EQ(cone.added_mass(0, 3), 0);
  for (const FluidBody& body : {built(Box{{2, 3, 4}}), cone}) {
    EXPECT_EQ(lastSetting(body.provenance), "added mass tables 1");
    checkFluidBody(body, "known");
  }
}

TEST(KnownShape, ProvenanceTellsTablesFromPanels) {
  const ShapeDescription box = describe(Box{{1, 2, 3}});
  ShapeBuildSettings settings;
  EXPECT_EQ(lastSetting(describeShape(box, settings)), "added mass tables 1");
  EXPECT_EQ(describeShape(box, settings).settings,
            buildShape(box, settings).body.provenance.settings);
  EXPECT_EQ(lastSetting(describeShape(describe(Box{{1, 2, 0.019}}), settings)), "panels 4200");
  settings.flow.solver = FlowSolverKind::Dense;
  EXPECT_EQ(lastSetting(describeShape(box, settings)), "dense");
  settings.flow.solver = FlowSolverKind::Automatic;
  settings.tables = false;
  EXPECT_EQ(lastSetting(describeShape(box, settings)), "panels 4200");
  EXPECT_EQ(lastSetting(describeShape(describe(Sphere{1}), settings)), "closed form");
}

TEST(KnownShape, BeyondTheTablesTheSolverIsAsked) {
  EXPECT_THROW(buildShape(describe(Box{{1, 2, 0.019}}), withoutMemory()), std::runtime_error);
}

/// A box of 12 triangles, two per side, the usual mesh of modelling programs.
TriangleMesh plainBox(const Eigen::Vector3d& half_sizes) { return makeBoxMesh(half_sizes, 12); }

Vector6 diagonalOf(const FluidBody& body) { return body.added_mass.diagonal(); }

/// Largest error over the largest entry, of the block that begins at `first`.
double blockError(const Vector6& value, const Vector6& reference, int first) {
  return (value - reference).segment<3>(first).cwiseAbs().maxCoeff() /
         reference.segment<3>(first).maxCoeff();
}

/// Largest off-diagonal entry over the largest of its block; lengths in half sizes.
double couplingOf(const Matrix6& K) {
  Matrix6 off = K;
  off.diagonal().setZero();
  return off.cwiseAbs().maxCoeff() / K.cwiseAbs().maxCoeff();
}

/// A box, the diagonal of its added mass, and the largest errors at default settings.
struct KnownBox {
  Vector3 half_sizes;
  double entries[6];
  double rotation, translation, coupling;
};

// The half cube: extrapolated Galerkin solutions, uncertainty 4e-4 and 2e-5. 1:20: extrapolated
// (order 2.6) from edge-graded meshes of about 1900 and 7500 triangles, each a panel; uncertainty
// 1e-3. Measured for the cube 6.2e-3 and 1.1e-3; long thin triangles of the rod break the symmetry,
// 1.6e-4 off the diagonal.
TEST(CoarseBox, IsRightAtDefaultSettings) {
  const double w = reference::cubeRotationalAddedMass(),
               v = 8 * reference::cubeAddedMassCoefficient();
  const KnownBox boxes[] = {
      {{1, 1, 1}, {w, w, w, v, v, v}, 8e-3, 2e-3, 1e-4},
      {{1, 1, 0.5},
       {0.7690680, 0.7690680, 0.5402426, 1.766754, 1.766754, 4.8151804},
       8e-3,
       2e-3,
       1e-4},
      {{1, 1, 0.05}, {0.71769, 0.71769, 0.015407, 0.033299, 0.033299, 4.00323}, 4e-3, 2e-3, 1e-4},
      {{1, 0.05, 0.05},
       {9.022e-6, 0.0070706, 0.0070706, 0.00071851, 0.022873, 0.022873},
       6e-3,
       4e-3,
       2e-4}};
  for (const KnownBox& box : boxes) {
    const FluidBody body = makeFluidBody(plainBox(box.half_sizes), {});
    const Vector6 reference = Eigen::Map<const Vector6>(box.entries);
    EXPECT_LT(blockError(diagonalOf(body), reference, 0), box.rotation);
    EXPECT_LT(blockError(diagonalOf(body), reference, 3), box.translation);
    EXPECT_LT(couplingOf(body.added_mass), box.coupling);
    EXPECT_EQ(body.faces.size(), 12u) << "the faces for the loads are the user's";
  }
}

// Half of each of the four moving sides of a spinning cube is windward: int x^3 over half a side, 4
// x 2 x 1/4.
TEST(CoarseBox, SpinIsDampedRightOnceTheFacesAreDivided) {
  const auto dampingOf = [](int least_faces) -> Vector6 {
    BuildSettings settings;
    settings.least_faces = least_faces;
    settings.flow.max_panels = 0;
    const FluidBody body = makeFluidBody(plainBox({1, 1, 1}), settings);
    EXPECT_GE(body.faces.size(), static_cast<std::size_t>(least_faces));
    LoadSettings medium;
    medium.density = 2;
    const Twist spin{{0, 0, 1}, {0, 0, 0}};
    return -computeFaceLoads(body.faces, std::sqrt(body.area), spin, medium).pressure.vector();
  };
  EXPECT_GT(std::abs(dampingOf(0)[2] / 4 - 1), 0.2) << "12 faces";
  const Vector6 damping = dampingOf(400);
  // 768 faces; measured 1e-15, by symmetry.
  EXPECT_NEAR(damping[2], 4, 1e-3);
  EXPECT_LT(damping.head<2>().norm(), 1e-6);
}

TEST(CoarseBox, SmoothMeshesAreSolvedOnTheirOwnTriangles) {
  BuildSettings settings;
  settings.flow.max_panels = 0;
  const TriangleMesh egg = makeEllipsoidMesh({1, 0.8, 0.7}, 1300);
  EXPECT_EQ(makeFluidBody(egg, settings).added_mass, makeFluidBody(egg, {}).added_mass);
}

}  // namespace
}  // namespace ambient
