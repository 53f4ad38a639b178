#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "preprocess/base/surface_form.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/part_bodies.h"

// Bodies that float at rest: whatever Bullet's precision, they can be pushed, are not halted, sleep
// where they do not move, and wake where their load changes.
namespace ambient::test {
namespace {

constexpr double kSteppings[] = {30, 60, 240};

struct Float {
  FluidBody shape;
  double mass = 1;
  Vector3 moments{1, 1, 1};
};

Float boxAfloat(const Vector3& size, double mass) {
  return {floatingBox(size), mass, boxMoments(size, mass)};
}

Float ballAfloat(double radius, double mass) {
  return {floatingBall(radius), mass, Vector3::Constant(0.4 * mass * radius * radius)};
}

// A cylinder along x whose mesh has `sides` sides.
Float barrelOf(double radius, double length, int sides, double mass) {
  Triangulation mesh;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * i / sides;
    const Vector3 rim(0, radius * portable::cos(angle), radius * portable::sin(angle));
    for (const double end : {-length / 2, length / 2})
      mesh.vertices.push_back(rim + Vector3(end, 0, 0));
  }
  mesh.vertices.push_back({-length / 2, 0, 0});
  mesh.vertices.push_back({length / 2, 0, 0});
  for (int i = 0; i < sides; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % sides);
    mesh.triangles.emplace_back(a, b + 1, a + 1);
    mesh.triangles.emplace_back(a, b, b + 1);
    mesh.triangles.emplace_back(2 * sides, b, a);
    mesh.triangles.emplace_back(2 * sides + 1, a + 1, b + 1);
  }
  Float barrel{hullBody(mesh), mass, {}};
  const double across = mass * (3 * radius * radius + length * length) / 12;
  barrel.moments = Vector3(mass * radius * radius / 2, across, across);
  barrel.shape.added_mass = facelessEllipsoid(Vector3(0.6 * length, radius, radius)).added_mass;
  makeSurfaceForm(barrel.shape);
  return barrel;
}

// Water below air.
struct Pool {
  btRigidBody& add(const Float& what, const Vector3& position,
                   const Quaternion& orientation = Quaternion::Identity(),
                   btCollisionShape* shape = nullptr) {
    return scene.add({what.mass, what.moments, startAt(position, {}, orientation), shape},
                     what.shape, Medium{});
  }
  // Steps until a body sleeps. Returns the time, `most` [s] at most.
  double timeUntilSleep(btRigidBody& body, double most, double hertz = 60) {
    for (int i = 0; i < most * hertz; ++i) {
      if (!body.isActive()) return i / hertz;
      scene.step(1 / hertz);
    }
    return most;
  }

  SeaWorld scene;
};

double alongX(const btRigidBody& body) {
  return static_cast<double>(body.getWorldTransform().getOrigin().x());
}

/// Distance over which a force [N] along x moves a body in 5 s that has floated for 20 s [m].
double pushed(const Float& what, double force, double hertz) {
  Pool pool;
  btRigidBody& body = pool.add(what, {0, 0, 0});
  pool.scene.step(1 / hertz, static_cast<int>(20 * hertz));
  const double start = alongX(body);
  for (int i = 0; i < 5 * hertz; ++i) {
    body.applyCentralForce({bt(force), 0, 0});
    pool.scene.step(1 / hertz);
  }
  EXPECT_EQ(pool.scene.fluid.counters().halted, 0);
  EXPECT_EQ(pool.scene.fluid.counters().too_long, 0);
  EXPECT_TRUE(pool.scene.said.empty()) << pool.scene.said.front();
  return alongX(body) - start;
}

// The distances are those in double at 1000 Hz.
TEST(FloatingRest, ABodyIsPushedInFloatAsInDouble) {
  for (const double hertz : {30.0, 60.0, 240.0, 1000.0}) {
    EXPECT_NEAR(pushed(boxAfloat({0.8, 0.6, 0.5}, 150), 5, hertz), 0.3001, 0.003) << hertz;
    EXPECT_NEAR(pushed(ballAfloat(0.5, 60), 2, hertz), 0.344, 0.0034) << hertz;
  }
}

TEST(FloatingRest, NobodyIsHaltedByRounding) {
  const auto halted = [](const std::shared_ptr<const WaterSurface>& waves, double scale) {
    FluidRegion sea = seaUnderAir();
    if (waves) sea.surface = waves;
    Pool pool{SeaWorld(sea)};
    const double weight = scale * scale * scale;
    const double density[] = {20, 500, 900};
    for (int i = 0; i < 3; ++i) {
      const double mass = density[i] * weight;
      const Quaternion turn(Eigen::AngleAxisd(0.05, Vector3(1, 0.4, 0.2).normalized()));
      const Vector3 size = scale * Vector3(1.2, 1, 0.4);
      pool.add(boxAfloat(size, 0.48 * mass), scale * Vector3(3 * i, 0, 0), turn);
      pool.add(ballAfloat(0.5 * scale, 0.5236 * mass), scale * Vector3(3 * i, 3, 0), turn);
      pool.add(barrelOf(0.3 * scale, scale, 12, 0.27 * mass), scale * Vector3(3 * i, 6, 0), turn);
    }
    for (const double hertz : {30.0, 60.0, 240.0, 1000.0})
      if (hertz * std::sqrt(scale) > 8) pool.scene.step(1 / hertz, 600);  // else it is too long
    EXPECT_TRUE(pool.scene.said.empty()) << pool.scene.said.front();
    return pool.scene.fluid.counters().halted;
  };
  for (const double scale : {0.02, 20.0}) {
    EXPECT_EQ(halted(nullptr, scale), 0) << scale;
    const std::vector<WaveComponent> waves{{0.05 * scale, 3 * std::sqrt(scale), {1, 0.3, 0}, 0}};
    EXPECT_EQ(halted(std::make_shared<AiryWaves>(CalmSea{}, waves), scale), 0) << scale;
  }
}

// A board of 20 kg/m^3, twenty times as wide as thick, at rest on the water.
TEST(FloatingRest, NothingIsSaidOfALightBoard) {
  const Vector3 size(2, 0.5, 0.05);
  const double draught = size.z() * (20 - air().density) / (water().density - air().density);
  for (const double hertz : kSteppings) {
    Pool pool;
    btRigidBody& board =
        pool.add(boxAfloat(size, 20 * size.prod()), {0, 0, size.z() / 2 - draught});
    pool.scene.step(1 / hertz, static_cast<int>(30 * hertz));
    EXPECT_TRUE(pool.scene.said.empty()) << pool.scene.said.front();
    EXPECT_EQ(pool.scene.fluid.counters().halted, 0) << hertz;
    EXPECT_NEAR(heightOf(board), size.z() / 2 - draught, 1e-4) << hertz;
  }
}

// A rail that lets a body move up and down only: rows move it.
TEST(FloatingRest, ABodyOnARailComesToItsBalance) {
  const double draught = 0.6 * (500 - air().density) / (water().density - air().density);
  for (const double hertz : {60.0, 240.0, 1000.0}) {
    Pool pool;
    btRigidBody& body = pool.add(boxAfloat({1, 0.8, 0.6}, 240), {0, 0, 0.02});
    pool.scene.contents.join(railOf(body, {0, 0, -1}, {0, 0, 1}));
    pool.scene.step(1 / hertz, static_cast<int>(35 * hertz));
    EXPECT_NEAR(heightOf(body), 0.3 - draught, 2e-6) << hertz;
  }
}

// A small displacement of these grows as little as it is turned back.
TEST(FloatingRest, SleepsInANeutralBalance) {
  const Quaternion edge_up(Eigen::AngleAxisd(kPi / 4, Vector3::UnitX()));
  const std::pair<Float, Quaternion> floats[] = {
      {ballAfloat(0.5, 0.3 * 523.6), Quaternion::Identity()},
      {barrelOf(0.4, 1.5, 48, 0.5 * 1000 * kPi * 0.16 * 1.5), Quaternion::Identity()},
      {boxAfloat({1, 1, 1}, (water().density + air().density) / 2), edge_up}};
  for (const double hertz : kSteppings)
    for (const auto& [what, orientation] : floats) {
      Pool pool;
      btRigidBody& body = pool.add(what, {0, 0, 0}, orientation);
      body.forceActivationState(ACTIVE_TAG);
      EXPECT_LT(pool.timeUntilSleep(body, 120, hertz), 100) << what.shape.volume << ", " << hertz;
      // At rest from the start it sleeps after Bullet's two seconds.
      body.setLinearVelocity({0, 0, 0});
      body.setAngularVelocity({0, 0, 0});
      body.forceActivationState(ACTIVE_TAG);
      body.setDeactivationTime(0);
      EXPECT_LT(pool.timeUntilSleep(body, 10, hertz), 2.1) << what.shape.volume << ", " << hertz;
    }
}

struct Barge {
  Vector3 size{5, 2, 0.8};
  double mass = 3500;
  btBoxShape shape{btVector3(bt(2.5), 1, bt(0.4))};
  Float what = boxAfloat(size, mass);
  /// Height of the centre with a load [m].
  double balance(double load) const {
    return 0.4 - (mass + load) / (water().density * size.x() * size.y());
  }
};

void expectRestAtBalance(Pool& pool, btRigidBody& body, double height, double hertz) {
  const double slept = pool.timeUntilSleep(body, 300, hertz);
  EXPECT_GT(slept, 4) << hertz;
  EXPECT_LT(slept, 290) << hertz;
  EXPECT_NEAR(heightOf(body), height, 0.01) << hertz;
}

void letABargeWithACrateRest(double hertz) {
  Pool pool;
  Barge barge;
  btBoxShape box(btVector3(bt(0.4), bt(0.4), bt(0.4)));
  btRigidBody& body =
      pool.add(barge.what, {0, 0, barge.balance(200) + 0.1}, Quaternion::Identity(), &barge.shape);
  btRigidBody& crate = pool.add(boxAfloat({0.8, 0.8, 0.8}, 200), {0, 0, barge.balance(200) + 0.9},
                                Quaternion::Identity(), &box);
  for (btRigidBody* each : {&body, &crate}) each->forceActivationState(ACTIVE_TAG);
  expectRestAtBalance(pool, body, barge.balance(200), hertz);
  EXPECT_FALSE(crate.isActive());
}

TEST(FloatingRest, ABargeWithACrateSleepsAtItsBalance) {
  for (const double hertz : kSteppings) letABargeWithACrateRest(hertz);
}

void letBargesOnAHingeRest(double hertz) {
  Pool pool;
  Barge barge;
  btRigidBody* bodies[2] = {};
  for (int i = 0; i < 2; ++i) {
    bodies[i] = &pool.add(barge.what, {5.4 * i, 0, barge.balance(0) + 0.1}, Quaternion::Identity(),
                          &barge.shape);
    bodies[i]->forceActivationState(ACTIVE_TAG);
  }
  btHingeConstraint hinge(*bodies[0], *bodies[1], {bt(2.7), 0, 0}, {bt(-2.7), 0, 0}, {0, 1, 0},
                          {0, 1, 0});
  pool.scene.world.addConstraint(&hinge, true);
  expectRestAtBalance(pool, *bodies[0], barge.balance(0), hertz);
  EXPECT_FALSE(bodies[1]->isActive());
  pool.scene.world.removeConstraint(&hinge);
}

TEST(FloatingRest, BargesOnAHingeSleepAtTheirBalance) {
  for (const double hertz : kSteppings) letBargesOnAHingeRest(hertz);
}

TEST(FloatingRest, AChangeOfMassWakes) {
  Pool pool;
  Barge barge;
  btRigidBody& body = pool.add(barge.what, {0, 0, barge.balance(0)});
  pool.scene.step(1.0 / 60);  // the pool is new, and wakes all
  body.forceActivationState(ISLAND_SLEEPING);
  pool.scene.step(1.0 / 60, 10);
  ASSERT_FALSE(body.isActive());
  const double factor = 1.1;
  body.setMassProps(bt(factor * barge.mass), toBullet(Vector3(factor * barge.what.moments)));
  body.updateInertiaTensor();
  pool.scene.step(1.0 / 60);
  EXPECT_TRUE(body.isActive());
  EXPECT_LT(pool.timeUntilSleep(body, 300), 290);
  EXPECT_NEAR(heightOf(body), barge.balance(0.1 * barge.mass), 0.01);
}

}  // namespace
}  // namespace ambient::test
