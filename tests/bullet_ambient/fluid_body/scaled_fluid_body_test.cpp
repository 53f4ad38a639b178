#include <gtest/gtest.h>

#include <stdexcept>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::test {
namespace {

constexpr double kFactor = 1.7;

TEST(ScaledFluidBody, IsTheBodyOfTheScaledShape) {
  const Vector3 semi_axes(0.3, 0.2, 0.1);
  const FluidBody expected = meshedEllipsoid(kFactor * semi_axes, 1);
  const FluidBody body = scaled(meshedEllipsoid(semi_axes, 1), kFactor);
  EXPECT_LT((body.added_mass - expected.added_mass).norm(), 1e-14 * expected.added_mass.norm());
  EXPECT_NEAR(body.volume, expected.volume, 1e-14 * expected.volume);
  EXPECT_NEAR(body.area, expected.area, 1e-14 * expected.area);
  ASSERT_EQ(body.faces.size(), expected.faces.size());
  for (std::size_t i = 0; i < body.faces.size(); ++i) {
    EXPECT_LT((body.faces.normal(i) - expected.faces.normal(i)).norm(), 1e-14);
    EXPECT_LT((body.faces.centroid(i) - expected.faces.centroid(i)).norm(), 1e-14);
    EXPECT_NEAR(body.faces.area[i], expected.faces.area[i], 1e-14 * expected.faces.area[i]);
  }
}

TEST(ScaledFluidBody, ScalesCouplingMassDistributionAndSurface) {
  const FluidBody unit = exampleBody();
  const FluidBody body = scaled(unit, 2);
  EXPECT_EQ(body.added_mass(0, 4), 16 * unit.added_mass(0, 4));
  EXPECT_EQ(body.centre_of_volume, Vector3(2 * unit.centre_of_volume));
  EXPECT_EQ(body.origin, Vector3(2 * unit.origin));
  FluidBody anew = body;
  makeSurfaceForm(anew);
  EXPECT_EQ(contentHash(body), contentHash(anew)) << "the form is scaled along";
  EXPECT_EQ(body.uniform_mass.centre, Vector3(2 * unit.uniform_mass.centre));
  EXPECT_EQ(body.surface_mass.inertia, Matrix3(4 * unit.surface_mass.inertia));
  EXPECT_EQ(body.surface.vertices.back(), 2 * unit.surface.vertices.back());
  EXPECT_EQ(body.surface.triangles, unit.surface.triangles);
  EXPECT_EQ(body.provenance.settings, unit.provenance.settings + "; scaled by 2");
}

TEST(ScaledFluidBody, ScalesTheViscousForm) {
  const FluidBody unit = viscousBody(), body = scaled(unit, 2);
  const ViscousForm& from = unit.viscous;
  const ViscousForm& to = body.viscous;
  EXPECT_EQ(to.resistance(0, 1), 8 * from.resistance(0, 1));
  EXPECT_EQ(to.resistance(1, 4), 4 * from.resistance(1, 4));
  EXPECT_EQ(to.resistance(5, 5), 2 * from.resistance(5, 5));
  EXPECT_EQ(to.centre_of_reaction, Vector3(2 * from.centre_of_reaction));
  EXPECT_EQ(to.surface.diameter, 2 * from.surface.diameter);
  EXPECT_EQ(to.surface.frontal, Vector3(4 * from.surface.frontal));
  EXPECT_EQ(to.surface.moments, Vector3(4 * from.surface.moments));
  EXPECT_EQ(to.surface.gyration, Matrix3(4 * from.surface.gyration));
  EXPECT_EQ(to.separation.ways[3].thickness, from.separation.ways[3].thickness);
}

TEST(ScaledFluidBody, ScalesThePartsOfTheAddedMass) {
  FluidBody unit = exampleBody();
  unit.added_mass_parts = std::vector{AddedMassPart{{1, 2, 3}, Vector6::Ones(), unit.added_mass}};
  const FluidBody body = scaled(unit, 2);
  EXPECT_EQ(body.added_mass_parts[0].centre, Vector3(2, 4, 6));
  EXPECT_EQ(body.added_mass_parts[0].spread, Vector6(4 * Vector6::Ones()));
  EXPECT_EQ(body.added_mass_parts[0].inertia, scaleShape(unit.added_mass_parts[0].inertia, 2));
}

TEST(ScaledFluidBody, ScalesTheWaterlineTable) {
  FluidBody unit = exampleBody();
  unit.waterline = {1, {0.5}, {6, unit.added_mass}};
  const FluidBody body = scaled(unit, 2);
  EXPECT_EQ(body.waterline.immersions, unit.waterline.immersions);
  EXPECT_EQ(body.waterline.corrections[5], body.added_mass);
}

TEST(ScaledFluidBody, RefusesAFactorThatIsNotPositive) {
  EXPECT_THROW(scaled(exampleBody(), 0), std::invalid_argument);
  EXPECT_THROW(scaled(exampleBody(), -1), std::invalid_argument);
  EXPECT_THROW(scaled(exampleBody(), std::nan("")), std::invalid_argument);
  EXPECT_THROW(scaled(exampleBody(), 1e100), std::invalid_argument);
  EXPECT_THROW(scaled(exampleBody(), 1e-200), std::invalid_argument);
}

}  // namespace
}  // namespace ambient::test
