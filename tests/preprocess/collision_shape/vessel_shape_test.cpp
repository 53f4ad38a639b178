#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "preprocess/floating/floating_body.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/preprocess/mesh/vessel_meshes.h"
#include "tests/support/world.h"

// A tray of 1 x 0.6 x 0.4 m with walls of 2 cm and 60 kg in fresh water.
namespace ambient::test {
namespace {

constexpr double kLength = 1, kWidth = 0.6, kHeight = 0.4, kWall = 0.02, kMass = 60;
constexpr double kHold = 0.96 * 0.56 * 0.38;
constexpr double kDraught = kMass / (998 * kLength * kWidth);

/// The boxes of the tray: middles and sizes, its floor at z = 0.
struct Part {
  Vector3 middle, size;
};
std::vector<Part> trayParts() {
  const double x = (kLength - kWall) / 2, y = (kWidth - kWall) / 2, tall = kHeight - kWall;
  const double z = kWall + tall / 2;
  return {{{0, 0, kWall / 2}, {kLength, kWidth, kWall}},
          {{-x, 0, z}, {kWall, kWidth, tall}},
          {{x, 0, z}, {kWall, kWidth, tall}},
          {{0, -y, z}, {kLength - 2 * kWall, kWall, tall}},
          {{0, y, z}, {kLength - 2 * kWall, kWall, tall}}};
}

/// The tray as a btCompoundShape of five boxes.
struct BoxTray {
  std::vector<std::unique_ptr<btBoxShape>> boxes;
  btCompoundShape shape;

  BoxTray() {
    for (const Part& part : trayParts()) {
      boxes.push_back(std::make_unique<btBoxShape>(toBullet(Vector3(part.size / 2))));
      shape.addChildShape(btTransform(btQuaternion::getIdentity(), toBullet(part.middle)),
                          boxes.back().get());
    }
  }
};

TriangleMesh trayMesh() { return makeBarge({kLength, kWidth, kHeight, kWall}); }

std::string trayJson() {
  std::string parts;
  for (const auto& [middle, size] : trayParts()) {
    const auto list = [](const Vector3& v) {
      return "[" + std::to_string(v.x()) + "," + std::to_string(v.y()) + "," +
             std::to_string(v.z()) + "]";
    };
    parts += (parts.empty() ? "" : ",") + std::string(R"({"shape": {"type": "box", "size": )") +
             list(size) + R"(}, "position": )" + list(middle) + "}";
  }
  return R"({"type": "compound", "faces": 350, "parts": [)" + parts + "]}";
}

/// Draught, and metacentric heights by I/V + KB - KG of the closed box, within 0.5 %.
void expectTray(const FluidBody& body) {
  ASSERT_EQ(body.holds.size(), 1u);
  EXPECT_NEAR(body.holds[0].volume, kHold, 0.005 * kHold);
  EXPECT_NEAR(body.volume, kLength * kWidth * kHeight, 0.005 * body.volume);
  const double floor = kLength * kWidth * kWall;
  const double walls = (kLength * kWidth - 0.96 * 0.56) * (kHeight - kWall);
  const double KG = (floor * kWall / 2 + walls * (kHeight + kWall) / 2) / (floor + walls);
  FloatingBody floating;
  floating.shape = std::make_shared<FluidBody>(body);
  floating.mass = kMass;
  floating.centre_of_mass = body.uniform_mass.centre;
  floating.inertia = kMass * body.uniform_mass.inertia;
  const PackedHull hull(body);
  const FloatingAttitude upright =
      describe(floating, hull, settle(floating, hull, Vector3(0.01, 0.02, 1).normalized()));
  EXPECT_NEAR(upright.up.z(), 1, 1e-6);
  EXPECT_NEAR(upright.draught, kDraught, 0.005 * kDraught);
  const double GM = kDraught / 2 + kWidth * kWidth / (12 * kDraught) - KG;
  EXPECT_NEAR(GM, 0.207, 0.0005);
  EXPECT_NEAR(upright.metacentres[0].height, GM, 0.005 * GM);
}

TEST(VesselShape, TrayOfBoxesIsAVesselAndOneLineSaysSo) {
  BoxTray tray;
  CollisionShapeSettings settings = coarse();
  settings.name = "tray";
  std::vector<std::string> lines;
  settings.report = [&](const std::string& line) { lines.push_back(line); };
  expectTray(makeFluidBody(tray.shape, settings));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].rfind("tray: hold of 0.204", 0), 0u) << lines[0];
  EXPECT_NE(lines[0].find(" m round at (0, 0, 0.4"), std::string::npos) << lines[0];
}

TEST(VesselShape, TrayOfTrianglesIsAVessel) {
  const test::GImpactMesh tray(trayMesh());
  const FluidBody body = makeFluidBody(tray.shape, coarse());
  expectTray(body);
  CollisionShapeSettings without = coarse();
  without.holds = false;
  const FluidBody walls = makeFluidBody(tray.shape, without);
  EXPECT_TRUE(walls.holds.empty());
  EXPECT_NEAR(walls.volume, kLength * kWidth * kHeight - kHold, 1e-6);
  // The walls are the same, whatever is in between.
  EXPECT_LT((body.uniform_mass.centre - walls.uniform_mass.centre).norm(), 1e-6);
  EXPECT_LT((body.uniform_mass.inertia - walls.uniform_mass.inertia).norm(), 1e-6);
  EXPECT_LT((body.surface_mass.inertia - walls.surface_mass.inertia).norm(), 1e-6);
}

TEST(VesselShape, TrayInJsonIsAVessel) {
  ShapeBuildSettings settings;
  settings.flow.max_panels = 0;
  const ShapeDescription shape = readShape(parseJson(trayJson(), "tray"), ".", "tray");
  const BuiltBody built = buildShape(shape, settings);
  expectTray(built.body);
  settings.holds.is_wanted = false;
  EXPECT_TRUE(buildShape(shape, settings).body.holds.empty());
  EXPECT_NE(describeShape(shape, settings).settings, built.body.provenance.settings);
}

TEST(VesselShape, TrayFloatsInAWorldOfWater) {
  BoxTray tray;
  FluidBodyCache shapes(coarse());
  const MassDistribution mass = shapes.fluidBody(tray.shape)->uniform_mass;
  // Bullet's bodies have their centre of mass at the origin of their shape.
  btCompoundShape shape;
  shape.addChildShape(btTransform(btQuaternion::getIdentity(), toBullet(Vector3(-mass.centre))),
                      &tray.shape);
  WholeWorld<> host;
  host.world.setGravity(btVector3(0, 0, btScalar(-9.81)));
  const double afloat = mass.centre.z() - kDraught;  // height of its centre
  btRigidBody& body = host.contents.add(
      kMass, toBullet(Vector3(kMass * mass.inertia.diagonal())), shape,
      btTransform(btQuaternion::getIdentity(), toBullet(Vector3(0, 0, afloat + 0.05))));
  Fluid fluid(host.world);
  fluid.addRegion(waterBelow(0));
  fluid.addAll(shapes, air());
  host.step(1.0 / 60, 1200);
  double mean = 0;
  constexpr int kLast = 600;
  for (int i = 0; i < kLast; ++i) {
    host.step(1.0 / 60);
    mean += static_cast<double>(body.getWorldTransform().getOrigin().z()) / kLast;
  }
  EXPECT_NEAR(mean, afloat, 0.005 * kDraught);
  EXPECT_GT(body.getWorldTransform().getBasis()[2].z(), 0.999);
}

}  // namespace
}  // namespace ambient::test
