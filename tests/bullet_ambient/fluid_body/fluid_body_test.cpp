#include "bullet_ambient/fluid_body/fluid_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "preprocess/base/surface_form.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

TEST(SharedList, HasTheMemoryOfItsCopiesUntilItIsChanged) {
  SharedList<int> list{1, 2, 3};
  const SharedList<int> copy = list;
  EXPECT_EQ(copy.data(), list.data());
  list.own().push_back(4);
  EXPECT_EQ(copy.get(), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(list.get(), (std::vector<int>{1, 2, 3, 4}));
  const int* alone = list.data();
  list.own()[0] = 5;
  EXPECT_EQ(list.data(), alone) << "nobody else has it";
  EXPECT_TRUE(SharedList<int>().empty());
}

TEST(FaceTable, HoldsTheFacesInTheOrderAdded) {
  FaceTable faces;
  faces.add({1, 0, 0}, {1, 2, 3}, 4);
  faces.add({0, 0, -1}, {5, 6, 7}, 8);
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_EQ(faces.normal(0), Vector3(1, 0, 0));
  EXPECT_EQ(faces.centroid(0), Vector3(1, 2, 3));
  EXPECT_EQ(faces.area[0], 4);
  EXPECT_EQ(faces.normal(1), Vector3(0, 0, -1));
  EXPECT_EQ(faces.centroid(1), Vector3(5, 6, 7));
  EXPECT_EQ(faces.area[1], 8);
}

TEST(FaceTable, ReservesAllColumns) {
  FaceTable faces;
  faces.reserve(10);
  for (const auto* column : faces.columns()) EXPECT_GE(column->capacity(), 10u);
}

// Saved states of a body with the table must not fit a body without.
TEST(FluidBody, AWaterlineTableIsPartOfItsContent) {
  FluidBody body = test::exampleBody();
  const std::uint64_t without = contentHash(body);
  body.waterline = {1, {0.5}, {6, body.added_mass}};
  const std::uint64_t with = contentHash(body);
  EXPECT_NE(with, without);
  body.waterline.corrections[3](1, 2) += 1;
  EXPECT_NE(contentHash(body), with);
}

TEST(FluidBody, EachNumberOfItsViscousFormIsPartOfItsContent) {
  const FluidBody body = test::viscousBody();
  for (std::size_t i = 0; i < ViscousForm::kNumbers; ++i) {
    FluidBody other = body;
    *other.viscous.numbers()[i] += 1;
    EXPECT_NE(contentHash(other), contentHash(body)) << i;
  }
}

TEST(FluidBody, WhatTheSurfaceOfWaterAndTheFormLawNeedIsPartOfItsContent) {
  const FluidBody body = test::exampleBody();
  const std::uint64_t hash = contentHash(body);
  const auto changed = [&](auto change) {
    FluidBody other = body;
    change(other);
    return contentHash(other);
  };
  EXPECT_NE(changed([](FluidBody& b) { b.surface.vertices.push_back(1); }), hash);
  EXPECT_NE(changed([](FluidBody& b) { b.surface.triangles.own().push_back(1); }), hash);
  EXPECT_NE(changed([](FluidBody& b) { b.added_mass_parts = std::vector<AddedMassPart>(1); }),
            hash);
  EXPECT_NE(changed([](FluidBody& b) { b.faces.sharpness.push_back(0.5); }), hash);
  EXPECT_NE(changed([](FluidBody& b) { b.form_levels.emplace_back().faces.sharpness = {1}; }),
            hash);
}

// Numbers of a shape for the form law, docs/theory.md eq. (45a) to (45d).

TEST(FormShape, OfASheetIsAWingAsSharpAsItsBorder) {
  const FormShape shape = formShapeOf(test::rectangularWing(3));
  EXPECT_EQ(shape.wing, 1);
  EXPECT_EQ(shape.edges, 1);
  EXPECT_FALSE(shape.isSlender());
  EXPECT_NEAR(std::abs(shape.facing.z()), 1, 1e-14);
  EXPECT_NEAR(std::abs(shape.span.y()), 1, 1e-14);
  EXPECT_NEAR(shape.chord, 1, 0.01);
  EXPECT_NEAR(shape.aspect, 3, 0.03);
  EXPECT_NEAR(shape.pitching.norm(), std::sqrt(0.4 * (1 - 1.0 / 9)), 0.002);
}

TEST(FormShape, OfABodyAsThickAsWideIsABlock) {
  FluidBody body = test::bodyOfFaces(test::faceTableOf(test::geodesicSphere(2)));
  body.volume = 4 * kPi / 3;
  body.added_mass.bottomRightCorner<3, 3>() = Matrix3::Identity() * body.volume / 2;
  const FormShape shape = formShapeOf(body);
  EXPECT_EQ(shape.wing, 0);
  EXPECT_FALSE(shape.isWing());
}

TEST(FormShape, OfASmoothSlenderBodyHasItsLongAxis) {
  const FluidBody body = test::smoothHull({4, 1, 1});
  const FormShape shape = formShapeOf(body);
  EXPECT_EQ(shape.wing, 0);
  EXPECT_LT(shape.edges, 1e-12);
  EXPECT_NEAR(std::abs(shape.slender.normalized().x()), 1, 1e-12);
  // m^2 = (k2 - k1)/k2, eq. (45d)
  EXPECT_NEAR(shape.slender.squaredNorm(), (0.86 - 0.08) / 0.86, 1e-12);
}

TEST(FormShape, IsThatOfABlockWithoutAddedMassOrFaces) {
  FluidBody body = test::rectangularWing(2);
  body.added_mass.setZero();
  EXPECT_FALSE(formShapeOf(body).isWing());
  EXPECT_FALSE(formShapeOf(FluidBody{}).isWing());
  body = test::bodyOfFaces({});
  body.faces.add(Vector3::UnitZ(), Vector3::Zero(), 1);  // a single face has no chord
  EXPECT_FALSE(formShapeOf(body).isWing());
}

TEST(FormShape, DoesNotDependOnSizeAndTurnsWithTheBody) {
  const FluidBody wing = test::rectangularWing(3);
  const FormShape shape = formShapeOf(wing), large = formShapeOf(scaled(wing, 8));
  EXPECT_EQ(shape.wing, large.wing);
  EXPECT_EQ(shape.aspect, large.aspect);
  EXPECT_EQ(8 * shape.chord, large.chord);
  EXPECT_EQ(shape.span, large.span);
}

TEST(FormShape, ChangesWithThicknessWithoutAJump) {
  // V/k3 is the ratio of thickness to width: W falls from 1 to 0 as it grows to 1.
  double before = 1;
  for (double thickness = 0; thickness <= 1.2; thickness += 0.05) {
    FluidBody wing = test::rectangularWing(2);
    wing.volume = thickness * wing.added_mass(5, 5);
    const double now = formShapeOf(wing).wing;
    EXPECT_LE(now, before);
    EXPECT_GT(now, before - 0.2);
    EXPECT_NEAR(now, std::pow(std::max(1 - thickness * thickness, 0.0), 2), 1e-12);
    before = now;
  }
  EXPECT_EQ(before, 0);
}

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
