#include <gtest/gtest.h>
#include <malloc.h>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/wind.h"
#include "preprocess/base/surface_form.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/robots/state/robot_state_scene.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {
namespace {

// Two that fall into the sea far away, one upon the other.
void addFloatingBodies(FluidWorld& scene, BodyDef def) {
  FluidRegion sea;
  sea.bounds = RegionBounds{{900, -100, -100}, {1100, 100, 100}};
  sea.below = water();
  sea.surface =
      std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{{0.1, 3, {1, 0, 0}, 0}});
  scene.fluid.addRegion(sea);
  FluidBody shape = floatingEllipsoid(Vector3(0.3, 0.25, 0.1), 2);
  def.mass = 15;
  for (const double height : {1.0, 2.0}) {
    def.start.position = Vector3(1000, 0, height);
    scene.add(def, shape, Medium{});
  }
}

FluidBody formShape() {
  FluidBody shape = floatingEllipsoid(Vector3(0.3, 0.25, 0.1), 3);
  shape.faces.sharpness.assign(shape.faces.size(), 0.5);
  makeSurfaceForm(shape);
  return shape;
}

// Memory in use, by the allocator of glibc; sanitizers have another one, and it does not change.
std::size_t heldBytes() { return mallinfo2().uordblks; }

// Memory per body as in docs/bullet_step.md, by the form law without its reductions.
TEST(Attachment, OfAnEqualBodyTakesOneOrTwoKilobytes) {
  const auto shape = std::make_shared<const FluidBody>(formShape());
  for (const bool has_surface : {false, true}) {
    FluidWorld scene;
    FluidRegion sea = seaUnderAir();
    if (!has_surface) sea.surface = nullptr;
    scene.fluid.addRegion(sea);
    constexpr std::size_t kBodies = 512;
    std::vector<btRigidBody*> bodies;
    for (std::size_t i = 0; i <= kBodies; ++i) bodies.push_back(&scene.add(BodyDef{}));
    std::size_t before = 0;
    for (std::size_t i = 0; i <= kBodies; ++i) {
      if (i == 1) before = heldBytes();
      AttachDef def{shape, water()};
      def.flow.law = PressureLaw::kForm;
      scene.fluid.add(*bodies[i], def);
    }
    EXPECT_LT((heldBytes() - before) / kBodies, has_surface ? 2150U : 880U);
  }
}

// PyBullet's resetSimulation makes a new world for fluid bodies that are kept.
TEST(Attachment, InAnotherWorldMakesNoTables) {
  const auto shape = std::make_shared<const FluidBody>(formShape());
  const auto bytesOfAttaching = [&] {
    FluidWorld scene;
    scene.fluid.addRegion(seaUnderAir());
    btRigidBody& body = scene.add(BodyDef{});
    const std::size_t before = allocatedBytes();
    scene.fluid.add(body, AttachDef{shape, water()});
    return allocatedBytes() - before;
  };
  const std::size_t first = bytesOfAttaching();
  EXPECT_LT(bytesOfAttaching(), first / 20);
}

// Memory per region must depend neither on the number of regions nor on attached bodies.
TEST(Attachment, OfARegionToManyTakesSomeHundredBytes) {
  FluidWorld scene;
  for (int i = 0; i < 10; ++i) scene.add(BodyDef{}, formShape(), air());
  const auto add = [&](int from, int to) {
    const std::size_t before = allocatedBytes();
    for (int i = from; i < to; ++i) {
      FluidRegion zone;
      zone.below = air();
      zone.bounds = RegionBounds{{1.0 * i, 0, 0}, {i + 1.0, 1, 1}};
      scene.fluid.addRegion(zone);
    }
    return static_cast<double>(allocatedBytes() - before) / (to - from);
  };
  add(0, 1);
  EXPECT_LT(add(1, 1000), 2000);
  EXPECT_LT(add(1000, 5000), 2000);
}

// The first change of a body's mass ends its sharing of models; further ones rebuild its own.
TEST(Step, AllocatesOnceForABodyWhoseMassChanges) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-9.81)});
  scene.fluid.addRegion(waterBelow(0));
  AttachDef def{std::make_shared<const FluidBody>(floatingEllipsoid(Vector3(0.3, 0.25, 0.1), 2))};
  const auto add = [&](double mass) -> AmbientBody& {
    btRigidBody& body =
        scene.add({mass, mass * Vector3(0.02, 0.03, 0.04), startAt(Vector3(10 * mass, 0, 0))});
    scene.fluid.add(body, def);
    return *ambientBodiesOf(scene.fluid).find(&body);
  };
  const auto setMass = [](AmbientBody& ambient, double mass) {
    ambient.body->setMassProps(static_cast<btScalar>(mass),
                               toBullet(mass * Vector3(0.02, 0.03, 0.04)));
  };
  AmbientBody &changed = add(15), &other = add(15), &heavy = add(20);
  scene.step(1.0 / 60, 10);
  EXPECT_EQ(changed.models, other.models);
  EXPECT_NE(changed.models, heavy.models);
  setMass(changed, 17);
  scene.step(1.0 / 60);
  EXPECT_NE(changed.models, other.models);
  EXPECT_NEAR(other.model().mass, 15, 1e-5);
  const std::size_t before = allocationCount();
  setMass(changed, 20);
  scene.step(1.0 / 60, 10);
  EXPECT_EQ(allocationCount(), before);
  ASSERT_TRUE(changed.surface() && heavy.surface());
  EXPECT_EQ(changed.model().inertia, heavy.model().inertia);
  EXPECT_EQ(changed.surface()->below.inertia, heavy.surface()->below.inertia);
  EXPECT_EQ(changed.surface()->above.inverse_inertia, heavy.surface()->above.inverse_inertia);
}

struct NoShapes : FluidBodySource {
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape&) override { return nullptr; }
};

// First steps size every buffer. Scene: free bodies, some crossing regions, a body at
// rest on the floor, a pendulum with feedback. attachAll() watches the world for later
// bodies.
TEST(Step, AllocatesNothing) {
  btBoxShape floor_shape(btVector3(20, 20, 1));
  btSphereShape ball_shape(static_cast<btScalar>(0.3));
  FluidWorld scene;
  scene.world.setGravity({0, 0, static_cast<btScalar>(-9.81)});
  const FluidBody shape = floatingEllipsoid(Vector3(0.3, 0.25, 0.1), 2);
  BodyDef def{1, Vector3(0.02, 0.03, 0.04), {}, &floor_shape};
  BodyDef floor_def = def;
  floor_def.mass = 0;
  floor_def.start.position = Vector3(0, 0, -1.3);
  scene.add(floor_def);
  def.shape = &ball_shape;
  scene.add(def, shape, air());
  for (int i = 1; i < 5; ++i) {
    def.start.position = Vector3(2.0 * i, 0, 500);
    def.start.twist.angular = Vector3(1, 2, 5.0 * i);
    scene.add(def, shape, i % 2 ? air() : water());
  }
  def.start.position = Vector3(0, 5, 3);
  btRigidBody& bob = scene.add(def, shape, water());
  btPoint2PointConstraint joint(bob, btVector3(0, 0, 1));
  btJointFeedback feedback;
  joint.setJointFeedback(&feedback);
  scene.world.addConstraint(&joint);
  addFloatingBodies(scene, def);
  for (int layer = 0; layer < 20; ++layer) {
    FluidRegion region;
    region.below = layer % 2 ? air() : Medium{};
    if (layer % 2) {
      region.flow = drydenGusts({}) + turbulence({});
      region.layers = airLayers(0, 600);
    }
    region.bounds = RegionBounds{{-100, -100, 400.0 + 5 * layer}, {100, 100, 405.0 + 5 * layer}};
    scene.fluid.addRegion(region);
  }

  NoShapes no_shapes;
  AttachSettings settings;
  settings.later_bodies = true;
  scene.fluid.addAll(no_shapes, water(), settings);

  scene.step(1.0 / 60, 60);
  const std::size_t before = allocationCount();
  const long long evaluations = scene.fluid.counters().load_evaluations;
  const long long changes = scene.fluid.counters().medium_changes;
  const long long rows = scene.fluid.counters().rows;
  scene.step(1.0 / 60, 120);
  EXPECT_EQ(allocationCount(), before);
  EXPECT_GT(scene.fluid.counters().load_evaluations, evaluations + 120 * 3);
  EXPECT_GT(scene.fluid.counters().medium_changes, changes + 4);
  EXPECT_GT(scene.fluid.counters().rows, rows + 120);
  scene.world.removeConstraint(&joint);
}

// First steps size every buffer. Scenes: flight, motors and limits, contacts, joints to the world,
// the surface of water in waves.
TEST(RobotStep, AllocatesNothing) {
  for (const RobotStateKind kind : kRobotStateKinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    RobotStateScene scene(kind);
    // Bullet allocates memory in each step to sort pairs.
    scene.world().getDispatchInfo().m_deterministicOverlappingPairs = false;
    scene.step(360);
    const std::size_t before = allocationCount();
    scene.step(120);
    EXPECT_EQ(allocationCount(), before);
  }
}

}  // namespace
}  // namespace ambient::test
