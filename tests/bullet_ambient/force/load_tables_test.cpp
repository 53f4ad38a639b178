#include "bullet_ambient/force/loads/load_tables.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/surface/make_wetted_inertia.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

std::shared_ptr<const FluidBody> closedSphere() {
  return std::make_shared<const FluidBody>(test::hullBody(test::geodesicSphere(1)));
}

// Worlds of all threads ask for tables of one fluid body.
TEST(LoadTables, AreMadeOnceForEachFluidBody) {
  const auto body = closedSphere(), other = closedSphere();
  const PackedHull* hull = LoadTables(body).hull().get();
  std::vector<std::thread> threads;
  std::atomic<int> same{0};
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      const LoadTables tables(body);
      same += tables.hull().get() == hull;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(same, 4);
  EXPECT_NE(LoadTables(other).hull().get(), hull);
}

TEST(LoadTables, NeedAPreparedBodyForTheFormLawAndForHydrostatics) {
  const auto body = std::make_shared<FluidBody>(test::hullBody(test::geodesicSphere(1)));
  body->name = "old";
  body->form = {};
  const std::string expected =
      "fluid body 'old' is not prepared: call prepare() of preprocess/build.h, or upgrade its file "
      "with ambient_preprocess upgrade";
  EXPECT_EQ(test::refusalOf<std::invalid_argument>([&] { makeSurfaceLoads(body, water(), {}); }),
            expected);
  EXPECT_EQ(test::refusalOf<std::invalid_argument>([&] { LoadTables(body).hull(); }), expected);
  makeSurfaceForm(*body);
  EXPECT_NE(makeSurfaceLoads(body, water(), {}), nullptr);
}

// A world that is made anew finds them.
TEST(LoadTables, AreKeptUntilTheFluidBodyEnds) {
  const auto body = std::make_shared<const FluidBody>(test::hullBody(test::geodesicSphere(3)));
  const auto bytesOfLoads = [&] {
    const std::size_t before = test::allocatedBytes();
    LoadTables(body).hull();
    makeWaterlineLoads(body, water(), {});
    return test::allocatedBytes() - before;
  };
  const std::size_t first = bytesOfLoads();
  EXPECT_LT(bytesOfLoads(), first / 100);
}

TEST(LoadTables, EndWithTheFluidBodyAndItsLoads) {
  auto body = closedSphere();
  auto loads = makeWaterlineLoads(body, water(), {});
  auto wetted = makeWettedInertia(body);
  const std::weak_ptr<const FluidBody> watched = body;
  body = nullptr;
  EXPECT_FALSE(watched.expired()) << "loads hold it";
  loads = nullptr;
  wetted = nullptr;
  EXPECT_TRUE(watched.expired());
}

TEST(LoadTables, OfACopyAreItsOwn) {
  const auto body = closedSphere();
  const auto halfOf = [](const std::shared_ptr<const FluidBody>& of) {
    return LoadTables(of).hull()->corners().blocks[0].half[0];
  };
  const double half = halfOf(body);
  const auto copy = std::make_shared<FluidBody>(scaled(*body, 2));
  EXPECT_NEAR(halfOf(copy), 2 * half, 1e-12);
  *copy = scaled(*body, 3);
  EXPECT_NEAR(halfOf(copy), 3 * half, 1e-12);
}

TEST(LoadTables, HaveOneSetOfLoadsPerShapeFluidAndSettings) {
  const auto body = closedSphere(), same = closedSphere();
  const FlowSettings flow;
  const auto loads = makeSurfaceLoads(body, water(), flow);
  EXPECT_EQ(makeSurfaceLoads(body, water(), flow), loads);
  EXPECT_NE(makeSurfaceLoads(same, water(), flow), loads);
  EXPECT_NE(makeSurfaceLoads(body, air(), flow), loads);
  EXPECT_NE(makeWaterlineLoads(body, water(), flow), loads);
  FlowSettings others[7];
  others[0].separation_angle = 2;
  others[1].skin_friction = false;
  others[2].precision = LoadPrecision::kDouble;
  others[3].maximum_load_error = 0;
  others[4].law = PressureLaw::kPublished;
  others[5].stall_lag = 1;
  others[6].own_law = [](const auto& shape, const LoadSettings&) {
    return makeSurfaceLoads(std::make_shared<const FluidBody>(*shape), water(), {});
  };
  for (const FlowSettings& other : others) EXPECT_NE(makeSurfaceLoads(body, water(), other), loads);
  EXPECT_NE(makeSurfaceLoads(body, water(), others[6]), makeSurfaceLoads(body, water(), others[6]));
}

// Sums over all faces, for which a world that is made anew does not wait.
TEST(LoadTables, KeepTheDragOfEachSetOfFaces) {
  const auto body = std::make_shared<FluidBody>(test::hullBody(test::geodesicSphere(2)));
  body->viscous.separation.axes.setIdentity();
  body->viscous.surface.frontal = {2, 3, 4};
  const FaceTable& all = body->form.faces;
  FaceTable half;
  for (std::size_t i = 0; i < all.size(); i += 2) {
    half.add(all.normal(i), all.centroid(i), all.area[i]);
    half.sharpness.push_back(all.sharpness[i]);
  }
  const LoadTables tables(body);
  for (const FaceTable* faces : {&all, static_cast<const FaceTable*>(&half), &all}) {
    const Vector3 drag = tables.ownDrag({body, faces});
    for (int j = 0; j < 3; ++j)
      EXPECT_EQ(drag[j], ownDrag(*faces, *tables.shape(), body->viscous.separation.axes.col(j),
                                 body->viscous.surface.frontal[j]));
  }
  half.area.assign(half.size(), 0);
  EXPECT_GT(tables.ownDrag({body, &half})[0], 0) << "is not summed again";
}

TEST(LoadTables, PackTheSharpnessForTheFormLawOnly) {
  const auto body = closedSphere();
  const LoadTables tables(body);
  EXPECT_EQ(tables.packedFaces({body, &body->faces}, nullptr)->blocks().form, nullptr);
  EXPECT_NE(tables.packedFaces({body, &body->form.faces}, tables.shape().get())->blocks().form,
            nullptr);
}

}  // namespace
}  // namespace ambient
