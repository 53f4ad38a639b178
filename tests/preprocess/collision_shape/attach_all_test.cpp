#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/motion/surface/flotation.h"
#include "bullet_ambient/saved_state.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "preprocess/floating/floating_body.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/preprocess/mesh/vessel_meshes.h"
#include "tests/support/matrices.h"
#include "tests/support/world.h"

namespace ambient::test {
namespace {

// Typical scene: a floor, and crates and barrels, each with a shape of its own.
class CrateScene {
 public:
  CrateScene() {
    host.world.setGravity(btVector3(0, 0, btScalar(-9.81)));
    add(0, std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)));
    for (int i = 0; i < 4; ++i) {
      const auto half = static_cast<btScalar>(i < 2 ? 0.5 : 0.25);
      add(2000 * half, std::make_unique<btBoxShape>(btVector3(half, half, half)));
      add(300, std::make_unique<btCylinderShapeZ>(btVector3(half, half, 1)));
    }
  }
  void add(double mass, std::unique_ptr<btCollisionShape> shape) {
    const auto x = static_cast<btScalar>(3 * (host.contents.bodies().size() + 1));
    host.contents.add(mass, *shape, btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 5)));
    shapes.push_back(std::move(shape));
  }
  btRigidBody& body(std::size_t i) { return *host.contents.bodies()[i]; }

  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  test::WholeWorld<> host;
  Fluid fluid{host.world};
};

// Two sizes of one shape give two fluid bodies; their names identify them in another program.
TEST(AttachAll, LeavesWorldsWhoseStateCanBeSaved) {
  CrateScene scene, other;
  FluidBodyCache shapes(test::coarse()), others(test::coarse());
  scene.fluid.addAll(shapes, water());
  other.fluid.addAll(others, air());
  scene.host.step(1.0 / 60);
  const std::string bytes = encodeState(scene.fluid.save());
  const auto lookup = [&](const std::string& name) { return others.find(name); };
  other.fluid.restore(decodeState(bytes, "state", lookup));
  for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    EXPECT_EQ(other.body(i).getWorldTransform(), scene.body(i).getWorldTransform());
  EXPECT_EQ(other.fluid.find(other.body(1))->medium().density, water().density);
}

TEST(AttachAll, SaysWhatHasNoShape) {
  CrateScene scene;
  FluidBodyCache shapes(test::coarse());
  scene.body(1).setCollisionShape(nullptr);
  AttachSettings settings;
  settings.filter = [&](const btRigidBody& body) -> bool {
    if (&body == &scene.body(2)) throw 42;
    return true;
  };
  const AttachReport report = scene.fluid.addAll(shapes, water(), settings);
  EXPECT_EQ(report.attached, 6);
  ASSERT_EQ(report.refused.size(), 2u);
  EXPECT_EQ(report.refused[0].reason,
            "body 1: it has no collision shape, so that no fluid acts on it");
  EXPECT_EQ(report.refused[1].reason, "body 2 (CylinderZ): filter threw something unknown");
  scene.body(1).setCollisionShape(scene.shapes[1].get());
}

TEST(AttachAll, PutsAWorldIntoWaterInOneCall) {
  CrateScene scene;
  FluidBodyCache shapes(test::coarse());
  const AttachReport report = scene.fluid.addAll(shapes, water());
  EXPECT_EQ(report.attached, 8);
  EXPECT_EQ(report.fluid_bodies, 4);
  EXPECT_TRUE(report.refused.empty());
  EXPECT_EQ(shapes.counts().made, 3);        // two sizes of cubes share one form
  const btRigidBody& crate = scene.body(1);  // 1000 kg in 998 kg of water
  scene.host.step(1.0 / 60, 60);
  // Sinking at (1 - 0.998) g / (1 + C) at most; in air the crate would have hit the floor.
  EXPECT_GT(crate.getWorldTransform().getOrigin().z(), 4.9);
}

// A box of 20 kg/m^3 afloat: errors of the added mass of its wet part exceed the inertia of the box
// itself.

struct LightBox {
  btBoxShape shape{btVector3(btScalar(0.5), btScalar(0.3), btScalar(0.2))};
  FluidBodyCache shapes;
  std::shared_ptr<const FluidBody> fluid_body = shapes.fluidBody(shape);
  double mass = 20 * fluid_body->volume;
};

TEST(LightFloat, KeepsAQuarterOfItsInertiaHoweverItLies) {
  LightBox box;
  SurfaceModelDef def;
  def.shape = box.fluid_body;
  const Vector3 size(1, 0.6, 0.4), q = box.mass / 12 * size.cwiseAbs2();
  def.mass = {box.mass, Vector3(q.y() + q.z(), q.z() + q.x(), q.x() + q.y()).asDiagonal()};
  def.above = air();
  def.below = water();
  const SurfaceModel model = makeSurfaceModel(def);
  const Matrix6& own = model.above.inertia;
  double least = 1;
  for (const double depth : {0.002, 0.008, 0.02, 0.05})
    for (const double tilt : {0.0, 0.003, 0.03, 0.1, 0.4}) {
      SurfacePlane plane{Vector3(tilt / 3, -tilt, 1).normalized(), 0, water().density, 9.81};
      plane.height = depth - plane.normal.cwiseAbs().dot(size) / 2;
      const Flotation flotation = flotationAt(model, plane);
      const Matrix6 raw = inertiaAt(model, immersionOf(model, plane));
      const double share = generalizedEigenvalues(raw, own)[0];
      least = std::min(least, share);
      const Matrix6 K = flotation.inertia.full();
      EXPECT_GT(generalizedEigenvalues(K, own)[0], kLeastShare / 2) << depth << ' ' << tilt;
      const double rounding = 1e-9 * K.cwiseAbs().maxCoeff();
      if (share > kLeastShare) {
        EXPECT_EQ(K, SymmetricMatrix(raw).full()) << depth << ' ' << tilt;
      }
      EXPECT_LT((K * flotation.inverse.full() - Matrix6::Identity()).cwiseAbs().maxCoeff(), 1e-9);
      const double added = (K - raw).cwiseAbs().maxCoeff();
      EXPECT_LE(added, std::max(0.0, 1 - share) * own.cwiseAbs().maxCoeff() + rounding);
    }
  EXPECT_LT(least, 0) << "no place of this test needs it";
}

/// Distance over which a force of 0.03 N a kilogram pushes the box in 2 s [m], 20 s after it was
/// let go at a height of its centre [m].
double pushed(LightBox& box, double hertz, double height) {
  WholeWorld<> host;
  host.world.setGravity(btVector3(0, 0, btScalar(-9.81)));
  Fluid fluid(host.world);
  fluid.addRegion(waterBelow(0));
  btRigidBody& body = host.contents.add(
      box.mass, box.shape,
      btTransform(btQuaternion::getIdentity(), btVector3(0, 0, static_cast<btScalar>(height))));
  body.setActivationState(DISABLE_DEACTIVATION);
  fluid.add(body, {box.fluid_body});
  host.step(1 / hertz, static_cast<int>(20 * hertz));
  const btScalar start = body.getWorldTransform().getOrigin().x();
  for (int i = 0; i < 2 * hertz; ++i) {
    body.applyCentralForce(btVector3(static_cast<btScalar>(0.03 * box.mass), 0, 0));
    host.step(1 / hertz);
  }
  EXPECT_EQ(fluid.counters().halted, 0) << hertz;
  EXPECT_LT(fluid.counters().energy_removed, 50) << hertz;
  return static_cast<double>(body.getWorldTransform().getOrigin().x() - start);
}

TEST(LightFloat, IsPushedAlikeAtEveryStep) {
  LightBox box;
  for (const double hertz : {30.0, 60.0, 240.0}) {
    EXPECT_NEAR(pushed(box, hertz, 0.18), 0.0537, 0.0005) << hertz;
    EXPECT_NEAR(pushed(box, hertz, 0.05), 0.0537, 0.0015) << hertz << ", has turned a little";
  }
}

// A tray of 1 x 0.6 x 0.4 m with walls of 2 cm and 60 kg in fresh water.

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
