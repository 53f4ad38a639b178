#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/bits_of.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

FaceTable firstFaces(const FaceTable& faces, std::size_t count) {
  FaceTable first;
  for (std::size_t i = 0; i < count; ++i)
    first.add(faces.normal(i), faces.centroid(i), faces.area[i]);
  return first;
}

SingleMotion motionFor(float cosine, float friction) {
  return {{0.75f, -0.5f, 0.3f},
          {0.25f, 0.4f, -1.0f},
          -cosine * std::abs(cosine),
          1 - cosine * cosine,
          friction};
}

TEST(SingleSums, LeaveOutNoFaceThatTheFlowIsAttachedTo) {
  test::Arbitrary arbitrary(57);
  const FaceTable body = arbitrary.body(3);
  const PackedFaces packed(body);
  const FaceBlocks faces = packed.blocks();
  std::vector<FaceBounds> wide(faces.bounds, faces.bounds + (faces.count + 15) / 16);
  FaceBlocks not_known = faces;
  not_known.bounds = wide.data();
  for (FaceBounds& bounds : wide)
    for (float(&row)[FaceBounds::kBlocks] : bounds.reach)
      for (float& reach : row) reach = 4;
  int left_out = 0;
  for (int i = 0; i < 200; ++i) {
    SingleMotion motion = motionFor(0, 0.03f);
    for (int axis = 0; axis < 3; ++axis) {
      motion.angular[axis] =
          static_cast<float>(arbitrary.between(-1, 1)) * (i % 2 == 0 ? 1 : 0.01f);
      motion.linear[axis] = static_cast<float>(arbitrary.between(-1, 1));
    }
    const LoadSums some = sumBlocksBaseline(faces, motion);
    const LoadSums all = sumBlocksBaseline(not_known, motion);
    // Sums without the skipped blocks have other runs, hence other roundings.
    double largest = 0;
    for (const double value : all.wrench) largest = std::max(largest, std::abs(value));
    for (int row = 0; row < 6; ++row)
      EXPECT_NEAR(some.wrench[row], all.wrench[row], 2e-6 * largest) << i;
    if (test::bitsOf(some) != test::bitsOf(all)) ++left_out;
  }
  EXPECT_GT(left_out, 100);
}

TEST(SingleSums, OfACutBodyHaveTheBitsOfSumsThatDoNotKnowWhereBlocksLie) {
  test::Arbitrary arbitrary(58);
  const FaceTable body = arbitrary.body(3);
  for (const std::size_t count : {100, 1280}) {
    const PackedFaces packed(firstFaces(body, count));
    const FaceBlocks faces = packed.blocks();
    std::vector<FaceBoxes> wide(faces.boxes, faces.boxes + (faces.count + 15) / 16);
    std::vector<FaceBoxes> narrow = wide;
    for (FaceBoxes& boxes : wide)
      for (float& radius : boxes.radius) radius = 10;
    for (FaceBoxes& boxes : narrow) {
      for (float(&row)[FaceBoxes::kBlocks] : boxes.half)
        for (float& half : row) half = 0;
      for (float& radius : boxes.radius) radius = 0;
    }
    int wrong = 0;
    for (int i = 0; i < 200; ++i) {
      SingleMotion motion = motionFor(i % 3 == 0 ? -0.3f : 0, i % 2 == 0 ? 0 : 0.03f);
      const Vector3 s = arbitrary.vector().normalized();
      const SingleCut cut{
          {static_cast<float>(s.x()), static_cast<float>(s.y()), static_cast<float>(s.z())},
          static_cast<float>(arbitrary.between(-1, 1)),
          static_cast<float>(packed.areaUnit() /
                             (kPi * packed.lengthUnit() * packed.lengthUnit()))};
      motion.cut = &cut;
      const auto bitsWith = [&](const std::vector<FaceBoxes>& boxes) {
        FaceBlocks elsewhere = faces;
        elsewhere.boxes = boxes.data();
        return test::bitsOf(sumBlocksBaseline(elsewhere, motion));
      };
      const auto bits = test::bitsOf(sumBlocksBaseline(faces, motion));
      EXPECT_EQ(bits, bitsWith(wide)) << i;
      if (bits != bitsWith(narrow)) ++wrong;
    }
    EXPECT_GT(wrong, 100);
  }
}

// Scale of rounding errors: sum A |u_s| |u|; for torques times the body's size, 1.
double errorScale(const FaceTable& faces, const Twist& x, double density) {
  double scale = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vector3 u = x.at(faces.centroid(i));
    const Vector3 n = faces.normal(i);
    scale += faces.area[i] * (u - n.dot(u) * n).norm() * u.norm();
  }
  return 0.5 * density * scale;
}

bool isNearSeparation(const FaceTable& faces, const Twist& x, double cosine) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vector3 u = x.at(faces.centroid(i));
    if (std::abs(faces.normal(i).dot(u) - cosine * u.norm()) < 1e-6 * u.norm()) return true;
  }
  return false;
}

double singleError(const FaceTable& body, const Twist& x, const LoadSettings& settings) {
  return (computeFaceLoad(PackedFaces(body), 1, x, settings).vector() -
          computeFaceLoads(body, 1, x, settings).total().vector())
      .norm();
}

TEST(SingleLoads, AreThoseOfDoublePrecisionToRounding) {
  test::Arbitrary arbitrary(52);
  double worst_pressure = 0, worst_total = 0, worst_friction = 0;
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const FaceTable body = arbitrary.body(i % 4);
    const Twist x = arbitrary.twist(2, 3);
    const double alpha = i % 2 == 0 ? kPi / 2 : arbitrary.between(kPi / 2, kPi);
    LoadSettings settings{1.3, 1e-3, separationCosine(alpha), false};
    if (isNearSeparation(body, x, settings.separation_cosine)) continue;
    ++compared;
    const double scale = errorScale(body, x, settings.density);
    worst_pressure = std::max(worst_pressure, singleError(body, x, settings) / scale);
    settings.skin_friction = true;
    worst_total = std::max(worst_total, singleError(body, x, settings) / scale);
    settings.viscosity = 1e30;  // friction is 10^5 times the pressure
    const double friction = computeFaceLoads(body, 1, x, settings).friction.vector().norm();
    worst_friction = std::max(worst_friction, singleError(body, x, settings) / friction);
  }
  EXPECT_GT(compared, 150);
  EXPECT_LT(worst_pressure, 1e-6);
  EXPECT_LT(worst_total, 1e-6);
  EXPECT_LT(worst_friction, 2e-6);
  RecordProperty("pressure", std::to_string(worst_pressure * 1e9) + "e-9");
  RecordProperty("total", std::to_string(worst_total * 1e9) + "e-9");
  RecordProperty("friction", std::to_string(worst_friction * 1e9) + "e-9");
}

TEST(SingleLoads, OfAPlateBroadsideLoseNothingToItsNormalVelocity) {
  FaceTable plate;
  plate.add(Vector3::UnitZ(), {0.1, 0.2, 0}, 0.5);
  const LoadSettings settings{1.3, 1e-3, 0, true};
  for (const double incidence : {1e-1, 1e-2, 1e-3}) {
    const Twist x{Vector3::Zero(), {std::sin(incidence), 0, std::cos(incidence)}};
    const Vector6 exact = computeFaceLoads(plate, 1, x, settings).total().vector();
    const Vector6 single = computeFaceLoad(PackedFaces(plate), 1, x, settings).vector();
    EXPECT_LT((single - exact).norm(), 1e-6 * exact.norm()) << incidence;
  }
}

TEST(SingleLoads, ScaleWithTheMotionAndTheBodyOverTheWholeRange) {
  test::Arbitrary arbitrary(53);
  const FaceTable body = arbitrary.body(1);
  const Twist x = arbitrary.twist();
  const LoadSettings settings{1.3, 0, -0.5, false};
  const Vector6 load = computeFaceLoad(PackedFaces(body), 1, x, settings).vector();
  for (const double factor : {0x1p-400, 0x1p-40, 0x1p40, 0x1p400}) {
    const Twist scaled{factor * x.angular, factor * x.linear};
    const Vector6 by_motion = computeFaceLoad(PackedFaces(body), 1, scaled, settings).vector();
    EXPECT_EQ(by_motion, factor * factor * load);
  }
  for (const double factor : {0x1p-100, 0x1p100}) {
    FaceTable larger;
    for (std::size_t i = 0; i < body.size(); ++i)
      larger.add(body.normal(i), factor * body.centroid(i), factor * factor * body.area[i]);
    const Twist same{x.angular / factor, x.linear};
    const Wrench by_size = computeFaceLoad(PackedFaces(larger), 1, same, settings);
    EXPECT_EQ(by_size.force, factor * factor * load.tail<3>());
    EXPECT_EQ(by_size.torque, factor * factor * factor * load.head<3>());
  }
}

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
  EXPECT_EQ(makeWaterlineLoads(body, water(), flow), loads) << "the same faces are summed";
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

TEST(LoadTables, HaveOtherLoadsAtASurfaceWhereOtherFacesAreSummed) {
  auto body = std::make_shared<FluidBody>(test::hullBody(test::geodesicSphere(1)));
  FlowSettings flow;
  flow.law = PressureLaw::kPublished;
  EXPECT_EQ(makeWaterlineLoads(body, water(), flow), makeSurfaceLoads(body, water(), flow));
  flow.separation_angle = kPi;
  EXPECT_NE(makeWaterlineLoads(body, water(), flow), makeSurfaceLoads(body, water(), flow));
  body->form_levels.push_back({body->form.faces, 0.001});
  EXPECT_NE(makeWaterlineLoads(body, water(), {}), makeSurfaceLoads(body, water(), {}));
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
  EXPECT_EQ(tables.packedFaces({body, &body->faces}, nullptr)->blocks().sharpness, nullptr);
  EXPECT_NE(tables.packedFaces({body, &body->form.faces}, tables.shape().get())->blocks().sharpness,
            nullptr);
}

}  // namespace
}  // namespace ambient
