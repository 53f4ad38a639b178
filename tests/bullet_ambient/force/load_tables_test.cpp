#include "bullet_ambient/force/loads/load_tables.h"

#include <gtest/gtest.h>

#include "bullet_ambient/force/loads/surface_loads.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/hull_bodies.h"

namespace ambient {
namespace {

std::shared_ptr<const FluidBody> sphere() {
  FluidBody body;
  body.faces = test::faceTableOf(test::geodesicSphere(1));
  return std::make_shared<const FluidBody>(body);
}

std::shared_ptr<const FluidBody> closedSphere() {
  return std::make_shared<const FluidBody>(test::hullBody(test::geodesicSphere(1)));
}

std::shared_ptr<const PackedFaces> packed(LoadTables& tables,
                                          const std::shared_ptr<const FluidBody>& body) {
  return tables.packedFaces({body, &body->faces}, nullptr);
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

// Later media and settings of the shape reuse the faces.
TEST(LoadTables, KeepTheFacesOfTheFormLawAsLongAsLoadsAreUsed) {
  LoadTables tables;
  const auto body = closedSphere();
  FlowSettings flow;
  flow.law = PressureLaw::kForm;
  auto loads = makeSurfaceLoads(body, water(), flow, tables);
  const std::weak_ptr<const FaceTable> faces = tables.formFaces(body);
  EXPECT_FALSE(faces.expired());
  loads = nullptr;
  EXPECT_TRUE(faces.expired());
}

TEST(LoadTables, HaveOneSetOfLoadsPerShapeFluidAndSettings) {
  LoadTables tables;
  const auto body = closedSphere(), same = closedSphere();
  const FlowSettings flow;
  const auto loads = makeSurfaceLoads(body, water(), flow, tables);
  EXPECT_EQ(makeSurfaceLoads(body, water(), flow, tables), loads);
  EXPECT_NE(makeSurfaceLoads(same, water(), flow, tables), loads);
  EXPECT_NE(makeSurfaceLoads(body, air(), flow, tables), loads);
  EXPECT_NE(makeWaterlineLoads(body, water(), flow, tables), loads);
  FlowSettings others[7];
  others[0].separation_angle = 2;
  others[1].skin_friction = false;
  others[2].precision = LoadPrecision::kDouble;
  others[3].maximum_load_error = 0;
  others[4].law = PressureLaw::kPublished;
  others[5].stall_lag = 1;
  others[6].own_law = [](const auto& shape, const LoadSettings&) {
    LoadTables own;
    return makeSurfaceLoads(shape, water(), {}, own);
  };
  for (const FlowSettings& other : others)
    EXPECT_NE(makeSurfaceLoads(body, water(), other, tables), loads);
  EXPECT_NE(makeSurfaceLoads(body, water(), others[6], tables),
            makeSurfaceLoads(body, water(), others[6], tables));
}

TEST(LoadTables, PackTheSharpnessForTheFormLawOnly) {
  LoadTables tables;
  FluidBody body = *sphere();
  body.faces.sharpness.assign(body.faces.size(), 0.5);
  const auto sharp = std::make_shared<const FaceTable>(body.faces);
  const ShapeFactors block{FormShape{}};
  EXPECT_EQ(tables.packedFaces(sharp, nullptr)->blocks().form, nullptr);
  EXPECT_NE(tables.packedFaces(sharp, &block)->blocks().form, nullptr);
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
