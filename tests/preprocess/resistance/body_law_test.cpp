#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

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
    EXPECT_NEAR(dragAlong(body, 0, reynolds[i], kPi) / along[i], 1, 0.02);
    EXPECT_NEAR(dragAlong(body, 1, reynolds[i], 2 * kPi) / across[i], 1, 0.02);
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
    EXPECT_NEAR(load.force.x(), row[1], 0.02 * std::abs(row[1]));
    EXPECT_NEAR(load.force.y(), row[2], 0.02);
    EXPECT_NEAR(load.torque.z(), row[3], 0.02 * row[3]);
  }
}

TEST(BodyLaw, CreepsByTheResistanceAlone) {
  const FluidBody body = ellipsoid({1, 2, 3});
  const Twist x{{0.3, -0.2, 0.1}, {1, 2, -1}};
  const double reynolds = 1e-5, viscosity = body.viscous.surface.diameter / reynolds;
  const Vector6 creeping = -viscosity * (body.viscous.resistance * x.vector());
  EXPECT_LT((loadAt(body, x, reynolds).vector() - creeping).norm(), 1e-3 * creeping.norm());
}

TEST(BodyLaw, TakesEnergyInEveryMotion) {
  test::Arbitrary random(7);
  for (const Vector3& axes : {Vector3(1, 1, 4), Vector3(0.3, 1, 1), Vector3(1, 2, 3)}) {
    const FluidBody body = ellipsoid(axes);
    for (int i = 0; i < 300; ++i) {
      const Twist x{random.vector(std::exp2(random.between(-20, 20))),
                    random.vector(std::exp2(random.between(-20, 20)))};
      const Wrench load = loadAt(body, x, std::exp2(random.between(-20, 25)));
      EXPECT_LT(power(load, x), 1e-12 * load.vector().norm() * x.vector().norm());
    }
  }
}

TEST(BodyLaw, ForceGoesWithTheSpeedAtAnySpin) {
  const FluidBody body = ellipsoid({1, 1, 2});
  const auto force = [&](double speed, double reynolds) {
    return loadAt(body, {{3, 1, 0.5}, {speed, 0.3 * speed, 0}}, reynolds).force.norm();
  };
  for (const double reynolds : {1.0, 1e4, 1e6}) {
    EXPECT_LT(force(1e-6, reynolds), 2e-3 * force(1e-3, reynolds));
    EXPECT_LT(force(0, reynolds), 1e-12);
  }
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
