#include "preprocess/resistance/prepare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

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
  body.surface.triangles.assign(mesh.triangles.data(),
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
