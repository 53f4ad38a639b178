#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/saved_state.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/support/world.h"

namespace ambient {
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

}  // namespace
}  // namespace ambient
