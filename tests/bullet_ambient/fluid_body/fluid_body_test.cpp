#include "bullet_ambient/fluid_body/fluid_body.h"

#include <gtest/gtest.h>

#include "bullet_ambient/spatial/spatial_vectors.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

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
  for (const auto* column : {&faces.normal_x, &faces.normal_y, &faces.normal_z, &faces.centroid_x,
                             &faces.centroid_y, &faces.centroid_z, &faces.area})
    EXPECT_GE(column->capacity(), 10u);
}

TEST(SlipMatrix, GivesTheTangentialVelocityOfTheFluidAtEveryFace) {
  test::Arbitrary arbitrary(1);
  const FaceTable faces = arbitrary.body();
  const Twist x = arbitrary.twist();
  const auto U = computeSlipMatrix(faces);
  ASSERT_EQ(U.rows(), static_cast<Eigen::Index>(3 * faces.size()));
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vector3 n = faces.normal(i);
    const Vector3 u = x.at(faces.centroid(i));
    const Vector3 slip = U.middleRows<3>(static_cast<Eigen::Index>(3 * i)) * x.vector();
    EXPECT_LT((slip - (n.dot(u) * n - u)).norm(), 1e-14 * u.norm()) << i;
    EXPECT_LT(std::abs(slip.dot(n)), 1e-14 * u.norm()) << i;
  }
}

TEST(SlipMatrix, OfNoFacesIsEmpty) { EXPECT_EQ(computeSlipMatrix(FaceTable{}).rows(), 0); }

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
  EXPECT_NE(changed([](FluidBody& b) { b.surface.triangles.push_back(1); }), hash);
  EXPECT_NE(changed([](FluidBody& b) { b.added_mass_parts = std::vector<AddedMassPart>(1); }),
            hash);
  EXPECT_NE(changed([](FluidBody& b) { b.faces.sharpness.push_back(0.5); }), hash);
  EXPECT_NE(changed([](FluidBody& b) { b.form_levels.emplace_back().faces.sharpness = {1}; }),
            hash);
}

}  // namespace
}  // namespace ambient
