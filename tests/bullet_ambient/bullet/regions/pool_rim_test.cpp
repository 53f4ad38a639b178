#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/reading.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/support/runs.h"

// Bodies across the rim of a pool, docs/theory.md section 17.
namespace ambient::test {
namespace {

const Vector3 kPlank(2, 0.3, 0.1);  // [m]
constexpr double kDraught = 0.06;   // [m]

AttachDef boxDef(const Vector3& size) {
  auto shape = longBox(size, 8);
  shape->name = "box";
  AttachDef def{shape};
  return def;
}

/// Water at rest below z = 0 under a vacuum.
FluidRegion poolOf(const RegionBounds& bounds) {
  FluidRegion pool = waterBelow(0);
  pool.below = idealFluid(1000);
  pool.above = Medium{};
  pool.bounds = bounds;
  return pool;
}

/// A pool that ends at x = 0.
FluidRegion poolBesideLand() { return poolOf({{-20, -10, -5}, {0, 10, 5}}); }

/// A plank at a distance from the rim, turned about the vertical. Held: its position is its own.
struct Rim : RobotWorld {
  Rim() { world.setGravity({0, 0, bt(-kGravity)}); }

  Immersed hold(Mover mover, const RigidState& at, const Vector3& size = kPlank) {
    const double mass = 200 * size.prod();
    const btVector3 moments = toBullet(boxMoments(size, mass));
    const btTransform pose(toBullet(at.orientation), toBullet(at.position));
    if (mover == Mover::kRigid) {
      btRigidBody& body = contents.add(mass, moments, no_shape_, pose);
      body.setActivationState(DISABLE_DEACTIVATION);
      body.setLinearFactor({0, 0, 0});
      body.setAngularFactor({0, 0, 0});
      return fluid.add(body, boxDef(size));
    }
    auto robot = std::make_unique<btMultiBody>(1, 0, btVector3(0, 0, 0), true, false);
    robot->setupFixed(0, bt(mass), moments, -1, btQuaternion::getIdentity(), {0, 0, 0}, {0, 0, 0});
    robot->finalizeMultiDof();
    robot->setBaseWorldTransform(pose);
    btMultiBody& tree = take(std::move(robot), 0);
    tree.setCanSleep(false);
    return fluid.add(tree, 0, boxDef(size));
  }
  btRigidBody& drop(const RigidState& at, double density, btCollisionShape* shape = nullptr,
                    const Vector3& size = kPlank) {
    const double mass = density * size.prod();
    btRigidBody& body =
        contents.add(mass, toBullet(boxMoments(size, mass)), shape ? *shape : no_shape_,
                     btTransform(toBullet(at.orientation), toBullet(at.position)));
    body.setLinearVelocity(toBullet(at.twist.linear));
    body.setAngularVelocity(toBullet(at.twist.angular));
    body.setActivationState(DISABLE_DEACTIVATION);
    fluid.add(body, boxDef(size));
    return body;
  }

 private:
  btEmptyShape no_shape_;
};

RigidState afloatAt(double x, double yaw = 0) {
  return startAt({x, 0.2, kPlank.z() / 2 - kDraught}, {},
                 Quaternion(Eigen::AngleAxisd(yaw, Vector3::UnitZ())));
}

/// Wrench of the water on a plank whose long sides are cut by the rim, about its centre of mass.
Wrench waterOn(double x, double yaw) {
  const double L = kPlank.x(), b = kPlank.y(), pull = 1000 * kGravity;
  const double cut = -x / std::cos(yaw), slope = std::tan(yaw);
  const double area = b * (L / 2 + cut);
  const double along = b / 2 * (cut * cut + slope * slope * b * b / 12 - L * L / 4) / area;
  const double across = slope * b * b * b / 12 / area;
  const Matrix3 R = Eigen::AngleAxisd(yaw, Vector3::UnitZ()).toRotationMatrix();
  Wrench water =
      Wrench::ofForceAt(pull * area * kDraught * Vector3::UnitZ(), R * Vector3(along, across, 0));
  const double bottom = -kPlank.z() / 2;
  water += Wrench::ofForceAt(pull * kDraught * kDraught / 2 * b / std::cos(yaw) * Vector3::UnitX(),
                             R * Vector3(cut, 0, 0) + (bottom + kDraught / 3) * Vector3::UnitZ());
  return water;
}

TEST(PoolRim, APlankIsCarriedByThePartThatIsOverThePool) {
  for (const Mover mover : {Mover::kRigid, Mover::kLink})
    for (const double x : {-0.5, -0.2, 0.0, 0.3, 0.5})
      for (const double yaw : {0.0, 0.4, -0.8, kPi + 0.2}) {
        Rim rim;
        rim.fluid.addRegion(poolBesideLand());
        const Immersed plank = rim.hold(mover, afloatAt(x, yaw));
        plank.readWrench(true);
        rim.step(1.0 / 60);
        const Wrench right = waterOn(x, yaw > kPi / 2 ? yaw - kPi : yaw);
        const Wrench found = plank.wrench().buoyancy;
        const double size = 1000 * kGravity * kPlank.x() * kPlank.y() * kDraught;
        const double rounding = byPrecision(1e-9, 1e-5) * size;
        EXPECT_LT((found.vector() - right.vector()).norm(), rounding) << x << " " << yaw;
        const WetState wet = plank.wet();
        EXPECT_NEAR(wet.volume, right.force.z() / (1000 * kGravity), byPrecision(1e-9, 1e-6));
        EXPECT_NEAR(wet.draught, kDraught, byPrecision(1e-9, 1e-6));
        EXPECT_NEAR((wet.centre_of_buoyancy.x() - x) * right.force.z(),
                    -right.torque.y() + right.force.x() * (-kPlank.z() / 2 + kDraught / 3),
                    2 * rounding);
      }
}

TEST(PoolRim, NothingJumpsWhereAPlankIsPushedAcrossIt) {
  const int half = static_cast<int>(runsOf(40));
  const double way = 1.25 / half, most = 1000 * kGravity * kPlank.y() * kDraught * way;
  const double rounding = byPrecision(1e-6, 1e-4);
  for (const Mover mover : {Mover::kRigid, Mover::kLink})
    for (const double depth : {0.0, 3.0}) {  // afloat, and where it is deep
      double last = 0, first = 0;
      for (int i = -half; i <= half; ++i) {
        Rim rim;
        rim.fluid.addRegion(poolBesideLand());
        RigidState at = afloatAt(way * i);
        at.position.z() -= depth;
        const Immersed plank = rim.hold(mover, at);
        plank.readWrench(true);
        rim.step(1.0 / 60);
        const double lift = plank.wrench().buoyancy.force.z();
        const double step = depth > 0 ? most * kPlank.z() / kDraught : most;
        if (i == -half) first = last = lift;
        EXPECT_LE(last - lift, step * (1 + rounding)) << way * i << " " << depth;
        EXPECT_GE(last - lift, -rounding * step) << way * i;
        last = lift;
      }
      EXPECT_EQ(last, 0);
      EXPECT_NEAR(first / (1000 * kGravity * kPlank.x() * kPlank.y()),
                  depth > 0 ? kPlank.z() : kDraught, 1e-6);
    }
}

// Velocities and counts of a box that falls into the water and drifts.
struct RimDrift {
  Twist twist;
  AmbientCounters counters;
};
RimDrift driftIn(const std::vector<FluidRegion>& regions, const Vector3& from) {
  Rim rim;
  for (const FluidRegion& region : regions) rim.fluid.addRegion(region);
  const btRigidBody& body =
      rim.drop(startAt(from, {Vector3(0.3, 0.7, -0.4), Vector3(0.05, -0.1, 0.3)},
                       Quaternion(1, 0.2, 0.1, -0.3).normalized()),
               500, nullptr, {0.8, 0.4, 0.3});
  rim.step(1.0 / 60, 60);
  return {ambient::velocityOf(body), rim.fluid.counters()};
}

void expectSameDrift(const RimDrift& a, const RimDrift& b) {
  EXPECT_EQ(a.twist.vector(), b.twist.vector());
  EXPECT_EQ(a.counters.substeps, b.counters.substeps);
  EXPECT_EQ(a.counters.load_evaluations, b.counters.load_evaluations);
  EXPECT_EQ(a.counters.faces, b.counters.faces);
}

TEST(PoolRim, CostsNothingWhereItDoesNotCutTheBody) {
  FluidRegion sea = poolBesideLand();
  sea.bounds.reset();
  const FluidRegion pool = poolBesideLand();
  const Vector3 amid(-3, 0, 0.1), beside(-0.6, 0, 0.1);  // it stays within 0.5 m of its centre
  expectSameDrift(driftIn({sea}, amid), driftIn({pool}, amid));
  EXPECT_EQ(driftIn({sea}, amid).counters.regions_asked,
            driftIn({pool}, amid).counters.regions_asked);
  expectSameDrift(driftIn({sea}, beside), driftIn({pool}, beside));
  const Vector3 across(0.1, 0, 0.1);
  EXPECT_NE(driftIn({sea}, across).twist.vector(), driftIn({pool}, across).twist.vector());
}

// Its centre stays on one side of the bound: in another region its wake begins anew.
TEST(PoolRim, WaterThatGoesOnBeyondABoundCarriesTheWholeBody) {
  FluidRegion sea = poolBesideLand(), other = poolOf({{0, -10, -5}, {20, 10, 5}});
  sea.bounds.reset();
  for (const double x : {-0.25, 0.15})
    EXPECT_EQ(driftIn({poolBesideLand(), other}, {x, 0, 0.1}).twist.vector(),
              driftIn({sea}, {x, 0, 0.1}).twist.vector());
}

// Load of deep water that ends at x = 0 on a plank that sinks, about its centre.
Wrench loadOfSinking(RegionBounds bounds, double x) {
  Rim rim;
  FluidRegion pool = poolOf(bounds);
  pool.surface = std::make_shared<StillWater>(3, Vector3(0, 0, 1));
  rim.fluid.addRegion(pool);
  RigidState at = afloatAt(x);
  at.twist.linear = {0, 0, -1};
  btRigidBody& body = rim.drop(at, 500);
  const Immersed plank = rim.fluid.find(body).value();
  plank.readWrench(true);
  return plank.wrench().pressure;
}

// Two pools on both sides of a rim have the load of one sea. The lever of the part in a pool is
// that of the force that it gains where the rim is moved along the plank.
TEST(PoolRim, ThePartInThePoolIsSlowedDown) {
  const RegionBounds pool = *poolBesideLand().bounds;
  const RegionBounds other{{0, -10, -5}, {20, 10, 5}};
  const Wrench whole = loadOfSinking(pool, -3), half = loadOfSinking(pool, 0);
  EXPECT_GT(whole.force.z(), 0);
  EXPECT_EQ(loadOfSinking(pool, 3).force.z(), 0);
  EXPECT_NEAR(half.force.z() / whole.force.z(), 0.5, 0.02);
  for (const double x : {-0.6, -0.1, 0.0, 0.35}) {
    const Wrench sum = loadOfSinking(pool, x) + loadOfSinking(other, x);
    EXPECT_LT((sum.vector() - whole.vector()).norm(), 1e-6 * whole.force.z()) << x;
  }
  double torque = 0;
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i)
    torque += loadOfSinking(pool, (i + 0.5) / kSteps * kPlank.x() * 0.6).force.z() *
              (kPlank.x() * 0.6 / kSteps);
  EXPECT_NEAR(half.torque.y() / torque, 1, 0.02);
}

/// Energy of the dry plank.
double dryEnergy(const btRigidBody& body) {
  const Vector3 w = toVector3(body.getAngularVelocity()), v = toVector3(body.getLinearVelocity());
  const Matrix3 R = toQuaternion(body.getWorldTransform().getRotation()).toRotationMatrix();
  const Vector3 moments = toVector3(body.getInvInertiaDiagLocal()).cwiseInverse();
  const double mass = 1 / static_cast<double>(body.getInvMass());
  const Vector3 w_B = R.transpose() * w;
  return w_B.dot(moments.cwiseProduct(w_B)) / 2 + mass * v.squaredNorm() / 2 +
         mass * kGravity * static_cast<double>(body.getWorldTransform().getOrigin().z());
}

struct RestingCase {
  double hertz, x, friction, density;
};

/// A plank that falls from above the water onto the rim and the land beside it.
struct RestingScene : Rim {
  explicit RestingScene(const RestingCase& with) {
    fluid.addRegion(poolBesideLand());
    for (btBoxShape* shape : {&land_, &plank_}) shape->setMargin(bt(0.01));
    btRigidBody& ground = contents.add(
        0, btVector3(0, 0, 0), land_, btTransform(btQuaternion::getIdentity(), {10, 0, bt(-0.97)}));
    RigidState at = afloatAt(with.x, 0.3);
    at.position.z() = 0.25;
    body = &drop(at, with.density, &plank_);
    for (btRigidBody* each : {&ground, body}) each->setFriction(bt(with.friction));
  }
  btRigidBody* body;

 private:
  btBoxShape land_{btVector3(10, 10, 1)}, plank_{toBullet(kPlank / 2)};
};

// Water at rest gives nothing. Planks come to rest on a rough rim, in the pool or on the land. From
// a smooth one they slide, and then no water that they are in speeds them up.
TEST(PoolRim, APlankOverTheRimGainsNoEnergy) {
  std::vector<RestingCase> cases;
  for (const double hertz : {30.0, 60.0})
    for (const double x : {-0.4, -0.2, 0.0, 0.2})
      for (const double friction : {0.0, 0.5})
        cases.push_back({hertz, x, friction, cases.size() / 2 % 2 == 0 ? 400.0 : 800.0});
  cases.push_back({240, -0.2, 0, 800});
  cases.push_back({240, 0, 0.5, 400});
  if (!AMBIENT_LONG_TESTS) cases = {{30, 0.2, 0.5, 800}, {60, -0.4, 0.5, 400}};
  for (const RestingCase& with : cases) {
    RestingScene scene(with);
    const btRigidBody& body = *scene.body;
    const double start = dryEnergy(body), scale = with.density * kPlank.prod() * kGravity;
    double lowest = start;  // since the plank has come to rest
    for (int i = 0; i < 55 * with.hertz; ++i) {
      scene.step(1 / with.hertz);
      const double now = dryEnergy(body);
      ASSERT_LE(now, start + 1e-3 * scale) << with.hertz << " Hz, " << with.x << ", " << i;
      if (i <= 45 * with.hertz) lowest = now;
      lowest = std::min(lowest, now);
      ASSERT_LE(now - lowest, 1e-5 * scale) << with.hertz << " Hz, " << with.x << ", " << i;
    }
    if (with.friction == 0) continue;
    EXPECT_LT(body.getLinearVelocity().length(), 1e-3) << with.hertz << " Hz, " << with.x;
    EXPECT_LT(body.getAngularVelocity().length(), 1e-3) << with.hertz << " Hz, " << with.x;
  }
}

TEST(PoolRim, AStateGoesOnBitForBit) {
  Rim one, other;
  const auto start = [](Rim& rim) {
    rim.fluid.addRegion(poolBesideLand());
    RigidState at = afloatAt(0.2, 0.3);
    at.twist = {Vector3(0.1, 0.3, 0.2), Vector3(-0.5, 0.1, 0.2)};
    rim.drop(at, 500);
    return SavedRun{rim.fluid, [&rim] { rim.step(1.0 / 60); }};
  };
  const SavedRun run = start(one), restored = start(other);
  one.step(1.0 / 60, 20);
  expectGoesOn(run, restored, 30);
}

}  // namespace
}  // namespace ambient::test
