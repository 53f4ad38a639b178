#include "bullet_ambient/force/load_tables.h"

#include <gtest/gtest.h>

#include "tests/support/geodesic.h"

namespace ambient {
namespace {

std::shared_ptr<const FluidBody> sphere() {
  FluidBody body;
  body.faces = test::faceTableOf(test::geodesicSphere(1));
  return std::make_shared<const FluidBody>(body);
}

std::shared_ptr<const PackedFaces> packed(LoadTables& tables,
                                          const std::shared_ptr<const FluidBody>& body) {
  return tables.packedFaces({body, &body->faces}, PressureLaw::kPublished);
}

TEST(LoadTables, HaveOneTablePerFluidBody) {
  LoadTables tables;
  const auto body = sphere(), same = sphere();
  const auto faces = packed(tables, body);
  EXPECT_EQ(packed(tables, body), faces);
  EXPECT_NE(packed(tables, same), faces);
}

TEST(LoadTables, TakeNoOtherFluidBodyAtTheSameAddressForTheOldOne) {
  LoadTables tables;
  FluidBody place;
  const auto keepPlace = [](const FluidBody*) {};
  place.faces = sphere()->faces;
  std::shared_ptr<const FluidBody> body(&place, keepPlace);
  const auto before = packed(tables, body);
  body.reset();
  place.faces = test::faceTableOf(test::geodesicSphere(0));
  body.reset(&place, keepPlace);
  EXPECT_EQ(packed(tables, body)->size(), 20u);
  EXPECT_EQ(before->size(), 80u);
}

TEST(LoadTables, KeepNoFacesThatNobodyUses) {
  LoadTables tables;
  const auto body = sphere();
  const std::weak_ptr<const PackedFaces> faces = packed(tables, body);
  EXPECT_TRUE(faces.expired());
}

TEST(LoadTables, PackTheSharpnessForTheFormLawOnly) {
  LoadTables tables;
  FluidBody body = *sphere();
  body.faces.sharpness.assign(body.faces.size(), 0.5);
  const auto sharp = std::make_shared<const FaceTable>(body.faces);
  EXPECT_EQ(tables.packedFaces(sharp, PressureLaw::kPublished)->blocks().form, nullptr);
  EXPECT_NE(tables.packedFaces(sharp, PressureLaw::kForm)->blocks().form, nullptr);
}

TEST(LoadTables, KeepAnUnusedSphereTableUntilTheNext) {
  LoadTables tables;
  const std::weak_ptr<const SphereTable> first = tables.sphereTable(0);
  EXPECT_EQ(tables.sphereTable(0), first.lock());
  const auto used = tables.sphereTable(-0.5);
  EXPECT_TRUE(first.expired());
  EXPECT_NE(tables.sphereTable(-0.6), used);
  EXPECT_EQ(tables.sphereTable(-0.5), used);
}

}  // namespace
}  // namespace ambient
