#include "preprocess/resistance/separation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/resistance/stokes_resistance.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

using Numbers = std::array<double, 8>;  // k_L, k_B, k_1, k_4, N, f_L, f_B, f_T

Numbers numbersOf(const SeparationWay& way) {
  return {way.wake_laminar, way.wake_bubble,      way.wake_turbulent,  way.wake_rough,
          way.thickness,    way.friction_laminar, way.friction_bubble, way.friction_turbulent};
}

Separation solved(const TriangleMesh& mesh) {
  const PotentialFlow flow = solvePotentialFlow(mesh);
  return computeSeparation(mesh, flow.potential.rightCols<3>(), translationAxes(flow.added_mass))
      .separation;
}

/// Expects numbers within a part of the expected ones, and k, which small ones of slender bodies do
/// not need, at least within a part of the ball's k_L.
void expectNear(const SeparationWay& way, const Numbers& expected, const Numbers& part, double of_k,
                const char* what) {
  const Numbers found = numbersOf(way);
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], part[i] * expected[i] + (i < 4 ? of_k * 1.898 : 0))
        << what << " number " << i;
}

TEST(MeshSeparation, LeavesABallWhereThwaitesAndTheRecoveryOfPressureSay) {
  // Thwaites' integral over the meridian: 103.57 degrees; the turbulent layer follows until 0.4 of
  // the pressure is recovered, sin^2 = 0.6: 129.23 degrees.
  const TriangleMesh mesh = makeEllipsoidMesh({1, 1, 1}, 2000);
  const PotentialFlow flow = solvePotentialFlow(mesh);
  const auto found =
      computeSeparation(mesh, flow.potential.rightCols<3>(), translationAxes(flow.added_mass));
  for (const LayerPlaces& places : found.leaves_at) {
    EXPECT_NEAR(places.laminar, (1 - std::cos(103.57 * kPi / 180)) / 2, 0.005);
    EXPECT_NEAR(places.turbulent, (1 - std::cos(129.23 * kPi / 180)) / 2, 0.015);
  }
}

struct Spheroid {
  double length;  ///< along the axis, over the diameter
  Numbers along, across;
};

// Along by Thwaites' and Buri's integrals over the meridian, across on a mesh of 8000 triangles:
// the prototype's table, to its digits.
const std::vector<Spheroid> kSpheroids = {
    {0.5,
     {4.158, 1.002, 1.654, 3.351, 0.1777, 6.152, 0.0923, 0.2763},
     {1.240, 0.1649, 0.1657, 0.7128, 0.512, 8.166, 0.0942, 0.4817}},
    {1,
     {1.898, 0.3578, 0.4860, 1.315, 0.3579, 6.586, 0.0929, 0.3619},
     {1.898, 0.3578, 0.4860, 1.315, 0.3579, 6.586, 0.0929, 0.3619}},
    {2,
     {0.9245, 0.0654, 0.0654, 0.4225, 0.6296, 8.450, 0.0930, 0.5402},
     {2.560, 0.5481, 0.8608, 1.905, 0.2869, 6.796, 0.0968, 0.3387}},
    {4,
     {0.4280, 0.00516, 0.00516, 0.0667, 0.9955, 12.49, 0.0854, 0.8813},
     {3.086, 0.751, 1.143, 2.355, 0.2320, 8.032, 0.1064, 0.3642}},
    {8,
     {0.1872, 0.00033, 0.00033, 0.00582, 1.500, 19.97, 0.0743, 1.539},
     {3.385, 0.855, 1.293, 2.600, 0.1924, 9.76, 0.118, 0.4026}}};

/// The longest axis comes first.
int axisOf(const Spheroid& body) { return body.length > 1 ? 0 : 2; }

TEST(SpheroidSeparation, IsThatOfTheMeridianAlongTheAxisAndOfThePrototypesMeshAcross) {
  // 8000 triangles: within 1.5 % (k_B 1.5 %, f_B 5 %), of k also half a per cent of the ball's. N
  // and k_B of the prototype across are taken at the vertex behind separation, 2 to 6 % off.
  const Numbers along = {0.01, 0.015, 0.015, 0.015, 0.015, 0.01, 0.07, 0.005},
                across = {0.01, 0.06, 0.02, 0.015, 0.06, 0.01, 0.06, 0.005};
  for (const Spheroid& body : kSpheroids) {
    const Separation separation = ellipsoidSeparation({body.length, 1, 1}, 8000);
    expectNear(separation.ways[2 * axisOf(body)], body.along, along, 0.001, "along");
    expectNear(separation.ways[2 * (2 - axisOf(body))], body.across, across, 0.001, "across");
  }
}

TEST(SpheroidSeparation, OnTwoThousandTrianglesIsWithinTwoPercent) {
  // k_B and k_1 7 %, f_B 12 %: they hang on the last few rings of triangles.
  const Numbers part = {0.02, 0.07, 0.07, 0.02, 0.02, 0.025, 0.12, 0.01};
  for (const Spheroid& body : kSpheroids)
    expectNear(ellipsoidSeparation({body.length, 1, 1}).ways[2 * axisOf(body)], body.along, part,
               0.004, "along");
}

TEST(MeshSeparation, OfSolvedFlowsIsThatOfTheClosedForm) {
  const Numbers part = {0.025, 0.1, 0.07, 0.03, 0.025, 0.035, 0.12, 0.01};
  for (const Spheroid& body : kSpheroids) {
    if (body.length > 4) continue;
    const Separation separation = solved(makeEllipsoidMesh({body.length, 1, 1}, 2000));
    expectNear(separation.ways[2 * axisOf(body)], body.along, part, 0.01, "along");
    expectNear(separation.ways[2 * (2 - axisOf(body)) + 1], body.across,
               {0.02, 0.12, 0.05, 0.03, 0.08, 0.035, 0.1, 0.02}, 0.01, "across");
    EXPECT_EQ(separation.smooth_base, Vector3(1, 1, 1));
  }
}

TEST(MeshSeparation, ConvergesWithTheMesh) {
  const auto error = [](int faces) {
    return std::abs(ellipsoidSeparation({2, 1, 1}, faces).ways[0].friction_laminar / 8.450 - 1);
  };
  EXPECT_GT(error(320) / error(1280), 3);
  EXPECT_GT(error(1280) / error(5120), 3);
}

TEST(MeshSeparation, DoesNotDependOnAttitudePlaceAndSize) {
  const TriangleMesh body = makeEllipsoidMesh({1.5, 1, 0.7}, 720);
  TriangleMesh other = body;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.8, Vector3d(2, -1, 1).normalized()).toRotationMatrix();
  other.vertices = (3 * (turn * body.vertices)).colwise() + Vector3d(1, -7, 2);
  const Separation a = solved(body), b = solved(other);
  for (std::size_t way = 0; way < 6; ++way)
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_NEAR(numbersOf(b.ways[way])[i], numbersOf(a.ways[way])[i],
                  1e-6 * (1 + numbersOf(a.ways[way])[i]))
          << way << " " << i;
}

TEST(MeshSeparation, OfIrregularMeshesIsNear) {
  // Vertices moved along the surface by up to a quarter of the edges.
  TriangleMesh mesh = makeEllipsoidMesh({1, 1, 1}, 2000);
  const double shift = 0.25 * (mesh.corner(0, 1) - mesh.corner(0, 0)).norm();
  unsigned state = 1;
  const auto random = [&] { return (state = state * 1664525 + 1013904223) / 2147483648.0 - 1; };
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    const Vector3d move(random(), random(), random());
    mesh.vertices.col(v) = (Vector3d(mesh.vertices.col(v)) + shift * move).normalized();
  }
  mesh.vertices.row(0) *= 2;
  for (const SeparationWay& way : {solved(mesh).ways[0], solved(mesh).ways[1]})
    expectNear(way, kSpheroids[2].along, {0.1, 0.2, 0.2, 0.1, 0.1, 0.1, 0.2, 0.03}, 0.02,
               "irregular");
}

TEST(MeshSeparation, IsFiniteForAnyBody) {
  std::vector<TriangleMesh> bodies = {
      makeBoxMesh({0.5, 0.3, 1}, {1, 1, 1}), makeEllipsoidMesh({1, 1, 0.05}, 80),
      makeEllipsoidMesh({20, 1, 1}, 20), makeConeMesh(0.5, 0.1, 100), makeConeMesh(0.5, 1.2, 300)};
  TriangleMesh beside = makeEllipsoidMesh({1, 1, 1}, 320);
  beside.vertices.row(0).array() += 5;
  bodies.push_back(joinMeshes({makeEllipsoidMesh({1, 1, 1}, 320), beside}));
  for (const TriangleMesh& body : bodies) {
    const Separation separation = solved(body);
    for (const SeparationWay& way : separation.ways)
      for (const double number : numbersOf(way)) {
        EXPECT_TRUE(std::isfinite(number));
        EXPECT_GE(number, 0);
      }
    EXPECT_GE(separation.smooth_base.minCoeff(), 0);
    EXPECT_LE(separation.smooth_base.maxCoeff(), 1);
  }
}

TEST(MeshSeparation, GivesTheSameBitsTwice) {
  const TriangleMesh body = makeEllipsoidMesh({1.5, 1, 0.7}, 720);
  const Separation a = solved(body), b = solved(body);
  for (std::size_t way = 0; way < 6; ++way)
    EXPECT_EQ(numbersOf(a.ways[way]), numbersOf(b.ways[way]));
}

TEST(SmoothBase, IsNoneWhereEdgesMakeIt) {
  const Separation box = solved(makeBoxMesh({0.5, 0.3, 1}, 800));
  EXPECT_LT(box.smooth_base.maxCoeff(), 1e-6);
  const Separation cylinder = solved(makeCylinderMesh(0.5, 8, 2000));
  EXPECT_LT(cylinder.smooth_base[0], 1e-6);  // end-on
  // Across, the side leaves smoothly; near the rims the flow comes over these.
  EXPECT_GT(cylinder.smooth_base[1], 0.8);
  EXPECT_GT(cylinder.smooth_base[2], 0.8);
  const Separation cone = solved(makeConeMesh(0.5, 2, 2000));
  EXPECT_LT(cone.smooth_base[0], 1e-6);  // either way
  EXPECT_EQ(solved(makeCapsuleMesh(0.5, 2, 2000)).smooth_base, Vector3(1, 1, 1));
}

TEST(CylinderSeparation, IsThatOfACircleOnDA) {
  Matrix3 axes;
  axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const double radius = 0.5, height = 12, area = 2 * kPi * radius * (radius + height),
               q = 2 * radius / std::sqrt(area / kPi);
  const Separation cylinder = cylinderSeparation(radius, height, axes);
  EXPECT_NEAR(cylinder.ways[2].thickness, 0.3154 * std::sqrt(q), 1e-12);
  EXPECT_NEAR(cylinder.ways[3].friction_laminar, 5.6795 / std::sqrt(q), 1e-12);
  EXPECT_NEAR(cylinder.ways[4].friction_turbulent, 0.3322 * std::pow(q, -0.2), 1e-12);
  EXPECT_EQ(cylinder.smooth_base[0], 0);
  EXPECT_NEAR(cylinder.smooth_base[1], 0.96, 1e-12);
  // A mesh of a long one has nearly these; its ends leave less of it in plane flow.
  const Separation mesh = solved(makeCylinderMesh(0.5, 8, 2000)),
                   known = cylinderSeparation(0.5, 8, mesh.axes);
  EXPECT_NEAR(mesh.ways[2].wake_laminar / known.ways[2].wake_laminar, 1, 0.07);
  EXPECT_NEAR(mesh.ways[2].friction_turbulent / known.ways[2].friction_turbulent, 1, 0.07);
  EXPECT_NEAR(mesh.ways[2].thickness / known.ways[2].thickness, 1, 0.12);
}

TEST(SphereSeparation, IsThatOfTheTable) {
  const Separation ball = sphereSeparation();
  for (const SeparationWay& way : ball.ways)
    expectNear(way, kSpheroids[1].along, {1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3}, 0,
               "ball");
}

TEST(TranslationAxes, AreRightHandedAndAscending) {
  Matrix6 K = Matrix6::Identity();
  K.bottomRightCorner<3, 3>() = Vector3(3, 1, 2).asDiagonal();
  const Matrix3 axes = translationAxes(K);
  EXPECT_LT((axes.col(0) - Vector3(0, 1, 0)).norm() + (axes.col(1) - Vector3(0, 0, 1)).norm(),
            1e-15);
  EXPECT_NEAR(axes.determinant(), 1, 1e-15);
}

// Loads on bodies at any Reynolds number, against the numbers of a program of their own,
// docs/theory.md section 19.

FluidBody ellipsoid(const Vector3& semi_axes) {
  FluidBody body = test::hullBody(test::geodesicEllipsoid(semi_axes, 4));
  body.added_mass = reference::ellipsoidAddedMass(semi_axes).asDiagonal();
  KnownViscousFlow known{ellipsoidResistance(semi_axes).asDiagonal(),
                         ellipsoidSeparation(semi_axes, 8000)};
  if (semi_axes == Vector3(2, 1, 1)) {  // by the integrals over the meridian
    const SeparationWay along{0.9245, 0.06535, 0.06535, 0.4225, 0.6296, 8.450, 0.09298, 0.5402},
        across{2.560, 0.5481, 0.8608, 1.905, 0.2869, 6.796, 0.09683, 0.3387};
    known.separation->ways = {along, along, across, across, across, across};
  }
  prepare(body, known);
  return body;
}

/// Load on a body that moves by x in a fluid of density 1 at Re = D_A/mu.
Wrench loadAt(const FluidBody& body, const Twist& x, double reynolds) {
  const Medium fluid{1, body.viscous.surface.diameter / reynolds, {0, 0, 0}, {0, 0, 0}};
  FlowSettings flow;
  flow.precision = LoadPrecision::kDouble;
  return makeSurfaceLoads(std::make_shared<const FluidBody>(body), fluid, flow)->load(x);
}

double dragAlong(const FluidBody& body, int axis, double reynolds, double area) {
  const Twist x{{0, 0, 0}, Vector3::Unit(axis)};
  return -2 * loadAt(body, x, reynolds).force[axis] / area;
}

TEST(BodyLaw, DragOfASpheroidHasItsNumbersFromStokesToTheCrisis) {
  const FluidBody body = ellipsoid({2, 1, 1});
  const double reynolds[] = {1, 10, 100, 1e3, 1e4, 1e5, 2e5, 1e6, 1e7};
  const double along[] = {42.296,  6.3285,   1.3088,   0.41092, 0.25587,
                          0.15399, 0.044443, 0.046959, 0.0404};
  const double across[] = {24.778,  4.0614,  1.1256,  0.54234, 0.52554,
                           0.64584, 0.65118, 0.17590, 0.25360};
  for (int i = 0; i < 9; ++i) {
    SCOPED_TRACE(reynolds[i]);
    EXPECT_NEAR(dragAlong(body, 0, reynolds[i], kPi) / along[i], 1, 0.01);
    EXPECT_NEAR(dragAlong(body, 1, reynolds[i], 2 * kPi) / across[i], 1, 0.01);
  }
}

TEST(BodyLaw, LoadOnAnInclinedSpheroidHasItsNumbers) {
  const FluidBody body = ellipsoid({2, 1, 1});
  const Twist x{{0, 0, 0.1}, Vector3(1, 1, 0).normalized()};
  const double expected[][4] = {{1e3, -1.1189, -0.85087, 0.89077},
                                {1e5, -1.1163, -1.2418, 1.8699},
                                {1e6, -0.61428, -0.14272, 1.0727}};
  for (const auto& row : expected) {
    SCOPED_TRACE(row[0]);
    const Wrench load = loadAt(body, x, row[0]);
    EXPECT_NEAR(load.force.x(), row[1], 0.01 * std::abs(row[1]));
    EXPECT_NEAR(load.force.y(), row[2], 0.01);
    EXPECT_NEAR(load.torque.z(), row[3], 0.01 * row[3]);
  }
}

TEST(BodyLaw, CreepsByTheResistanceAlone) {
  const FluidBody body = ellipsoid({1, 2, 3});
  const Twist x{{0.3, -0.2, 0.1}, {1, 2, -1}};
  const double reynolds = 1e-5, viscosity = body.viscous.surface.diameter / reynolds;
  const Vector6 creeping = -viscosity * (body.viscous.resistance * x.vector());
  EXPECT_LT((loadAt(body, x, reynolds).vector() - creeping).norm(), 1e-3 * creeping.norm());
}

const Vector3 kSemiAxes(0.3, 0.2, 0.1), kPlace(0.05, -0.1, 0.2);

/// An ellipsoid beside F's origin as a program fills it.
FluidBody bodyByHand() {
  TriangleMesh mesh = withVolume(makeEllipsoidMesh(kSemiAxes, 400), 4 * kPi / 3 * kSemiAxes.prod());
  mesh.vertices.colwise() += kPlace;
  FluidBody body;
  body.name = "by hand";
  body.volume = computeMassProperties(mesh).volume;
  body.area = computeMassProperties(mesh).area;
  body.centre_of_volume = kPlace;
  body.added_mass =
      shiftOrigin(Matrix6(ellipsoidAddedMass(kSemiAxes).asDiagonal()), Vector3(-kPlace));
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    body.faces.add(mesh.twiceArea(t).normalized(), mesh.barycentre(t),
                   mesh.twiceArea(t).norm() / 2);
  body.surface.vertices.assign(mesh.vertices.data(), mesh.vertices.data() + mesh.vertices.size());
  body.surface.triangles.own().assign(mesh.triangles.data(),
                                      mesh.triangles.data() + mesh.triangles.size());
  return body;
}

TEST(Prepare, GivesABodyMadeByHandItsResistanceAndSizes) {
  FluidBody body = bodyByHand();
  EXPECT_FALSE(isComplete(body));
  prepare(body);
  EXPECT_TRUE(isComplete(body));
  const ViscousForm& form = body.viscous;
  EXPECT_LT((form.centre_of_reaction - kPlace).norm(), 1e-4);
  const Vector6 R = shiftOrigin(form.resistance, kPlace).diagonal(),
                exact = ellipsoidResistance(kSemiAxes);
  EXPECT_LT(((R - exact).array() / exact.array()).abs().maxCoeff(), 5e-3);
  EXPECT_NEAR(form.surface.diameter, std::sqrt(body.area / kPi), 1e-12);
  // The longest axis comes first: it has the least added mass.
  EXPECT_NEAR(form.surface.frontal[0] / (kPi * kSemiAxes[1] * kSemiAxes[2]), 1, 0.02);
  EXPECT_GT(form.surface.moments[0], form.surface.moments[2]);
  EXPECT_LT(form.sharp_share, 0.3);
  EXPECT_EQ(form.separation.smooth_base, Vector3::Zero()) << "where the flow leaves is not known";
  checkFluidBody(body, "by hand");
}

TEST(Prepare, TakesWhatIsKnown) {
  FluidBody body = bodyByHand();
  KnownViscousFlow known;
  known.resistance = 2 * Matrix6::Identity();
  known.separation = sphereSeparation();
  known.is_primitive = true;
  prepare(body, known);
  EXPECT_EQ(body.viscous.resistance, *known.resistance);
  EXPECT_EQ(body.viscous.separation.smooth_base, Vector3(1, 1, 1));
  EXPECT_TRUE(body.viscous.is_primitive);
}

TEST(Prepare, LeavesSpheresWithoutAndBodiesWithoutASurfaceAsTheyAre) {
  FluidBody body = bodyByHand();
  body.viscous.sharp_share = 0.25;
  body.surface = {};
  prepare(body);
  EXPECT_EQ(body.viscous.sharp_share, 0.25);
  EXPECT_TRUE(isComplete(body));
  body.sphere_radius = 1;
  prepare(body);
  EXPECT_EQ(body.viscous.sharp_share, ViscousForm().sharp_share);
  EXPECT_TRUE(isComplete(body));
}

TEST(Prepare, ScaledBodiesHaveWhatIsComputedAnew) {
  FluidBody unit = bodyByHand();
  prepare(unit);
  const FluidBody body = scaled(unit, 3);
  FluidBody anew = body;
  prepare(anew);
  for (std::size_t i = 0; i < ViscousForm::kNumbers; ++i) {
    const double number = *anew.viscous.numbers()[i];
    EXPECT_NEAR(*body.viscous.numbers()[i], number, 1e-9 * (1 + std::abs(number))) << i;
  }
}

TEST(ReadPrepared, CompletesFilesOfEarlierVersions) {
  const TemporaryFolder folder;
  FluidBody body = bodyByHand();
  writeFluidBody(body, folder / "old.ambient");
  prepare(body);
  const FluidBody read = readPrepared(folder / "old.ambient");
  EXPECT_TRUE(isComplete(read));
  EXPECT_EQ(contentHash(read), contentHash(body));
  body.viscous = {};  // as of the version before
  writeFluidBody(body, folder / "old.ambient");
  EXPECT_EQ(contentHash(readPrepared(folder / "old.ambient")), contentHash(read));
}

TEST(ReadPrepared, NamesTheFileWhoseResistanceCannotBeSolved) {
  const TemporaryFolder folder;
  FluidBody body = bodyByHand();
  for (double& coordinate : body.surface.vertices) coordinate = 0;
  const auto file = folder / "flat.ambient";
  writeFluidBody(body, file);
  EXPECT_EQ(test::refusalOf([&] { readPrepared(file); }).find(file.string() + ": "), 0u);
}

}  // namespace
}  // namespace ambient
