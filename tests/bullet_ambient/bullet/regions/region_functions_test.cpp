#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

// Calls of a fluid from functions of its regions, and the time that they are given.

struct AskedWorld : FluidWorld {
  AskedWorld() {
    FluidRegion region = filledWith(idealFluid(900));
    region.flow = [this](const Vector3&, double time) {
      times.push_back(time);
      if (meddle) meddle();
      return FlowSample{};
    };
    asked = fluid.addRegion(region);
    def.fluid_body = std::make_shared<FluidBody>(floatingEllipsoid(kUnequalAxes, 1));
    fluid.add(body, def);
    step(kWorldStep);
    times.clear();
    said.clear();  // drops the warning of a light body
  }

  AttachDef def;
  btRigidBody& body = FluidWorld::add(tumblingBody(Vector3::Zero()));
  btRigidBody& other = FluidWorld::add(tumblingBody({3, 0, 0}));
  RegionId asked;
  std::function<void()> meddle;
  std::vector<double> times;
};

const std::pair<const char*, void (*)(AskedWorld&)> kMeddling[] = {
    {"add", [](AskedWorld& w) { w.fluid.add(w.other, w.def); }},
    {"remove", [](AskedWorld& w) { w.of(w.body).remove(); }},
    {"clear", [](AskedWorld& w) { w.fluid.clear(); }},
    {"addRegion", [](AskedWorld& w) { w.fluid.addRegion(filledWith(air())); }},
    {"setRegion", [](AskedWorld& w) { w.fluid.setRegion(w.asked, filledWith(air())); }},
    {"removeRegion", [](AskedWorld& w) { w.fluid.removeRegion(w.asked); }},
    {"setMedium", [](AskedWorld& w) { w.of(w.body).setMedium(idealFluid(1)); }},
    {"setFluidBody", [](AskedWorld& w) { w.of(w.body).setFluidBody(w.def.fluid_body); }},
    {"restoreState", [](AskedWorld& w) { w.fluid.restore(w.fluid.save()); }},
};

TEST(RegionFunctions, CannotChangeTheirFluid) {
  for (const auto& [name, change] : kMeddling) {
    AskedWorld world;
    world.meddle = [&world, change = change] { change(world); };
    world.step(kWorldStep, 3);
    ASSERT_EQ(world.said.size(), 1u) << name;
    EXPECT_EQ(
        world.said[0],
        std::string("bullet_ambient: the flow or the surface of a region of fluid has called ") +
            name +
            ", which changes what is asked for its fluid; nothing has changed: call it "
            "between steps");
    EXPECT_TRUE(world.fluid.find(world.body)) << name;
    EXPECT_EQ(world.fluid.size(), 1u) << name;
    EXPECT_EQ(world.of(world.body).medium().density, 900) << name;
    EXPECT_EQ(world.fluid.counters().rejected, 3) << name;
    world.meddle = nullptr;
    change(world);
  }
}

TEST(RegionFunctions, ThatCatchTheRefusalGoOn) {
  AskedWorld world;
  int refused = 0;
  world.meddle = [&] {
    try {
      world.of(world.body).remove();
    } catch (const std::logic_error&) {
      ++refused;
    }
  };
  world.step(kWorldStep, 3);
  EXPECT_EQ(refused, 3);
  EXPECT_EQ(world.fluid.counters().rejected, 0);
}

TEST(RegionFunctions, CannotChangeItWhileABodyIsAttached) {
  AskedWorld world;
  world.meddle = [&world] { world.of(world.body).remove(); };
  world.fluid.add(world.other, world.def);
  EXPECT_TRUE(world.fluid.find(world.body));
  EXPECT_TRUE(world.fluid.find(world.other));
}

TEST(RegionFunctions, OfASurfaceCannotEither) {
  AskedWorld world;
  FluidRegion sea = filledWith(water());
  sea.above = air();
  sea.surface = std::make_shared<WaterSurfaceFunction>([&world](const Vector3& point, double) {
    world.fluid.clear();
    return WaterSample{-point.z(), {0, 0, 0}, {0, 0, 0}};
  });
  world.fluid.setRegion(world.asked, sea);
  world.step(kWorldStep, 2);
  EXPECT_EQ(world.said.size(), 1u);
  EXPECT_EQ(world.fluid.size(), 1u);
}

TEST(RegionFunctions, MayChangeAnotherFluid) {
  AskedWorld world, far_away;
  world.meddle = [&far_away] { far_away.of(far_away.body).remove(); };
  world.step(kWorldStep);
  EXPECT_FALSE(far_away.fluid.find(far_away.body));
  EXPECT_TRUE(world.said.empty());
}

// Bullet disables bodies in infinite steps and does not move them.
TEST(StepsOfNoDuration, LeaveBodiesAndTimeAsTheyWere) {
  btBoxShape floor_shape(btVector3(9, 9, 1)), box(btVector3(1, 1, 1));
  for (const double duration : {kNotANumber, kFar}) {
    AskedWorld world;
    world.world.setGravity({0, 0, bt(-9.81)});
    world.FluidWorld::add({0, Vector3::Zero(), startAt({50, 0, -1}), &floor_shape});
    const btRigidBody& stone =
        world.FluidWorld::add({900 * 9, Vector3::Constant(5000), startAt({50, 0, 1}), &box},
                              *world.def.fluid_body, Medium{});
    world.step(kWorldStep, 60);
    const btRigidBody before(world.body), stone_before(stone);
    const long long rejected = world.fluid.counters().rejected;
    const double time = world.fluid.time();
    world.world.stepSimulation(static_cast<btScalar>(duration), 0);
    for (const auto& [now, then] :
         {std::pair<const btRigidBody*, const btRigidBody*>{&world.body, &before},
          std::pair<const btRigidBody*, const btRigidBody*>{&stone, &stone_before}}) {
      EXPECT_TRUE(now->getWorldTransform() == then->getWorldTransform()) << duration;
      EXPECT_TRUE(now->getLinearVelocity() == then->getLinearVelocity()) << duration;
      EXPECT_TRUE(now->getAngularVelocity() == then->getAngularVelocity()) << duration;
    }
    EXPECT_EQ(world.fluid.time(), time);
    EXPECT_EQ(world.fluid.counters().rejected, rejected);
    ASSERT_EQ(world.said.size(), 1u);
    EXPECT_NE(world.said[0].find("stepped by a time that is not finite"), std::string::npos);
    world.times.clear();
    world.step(kWorldStep, 60);
    if (duration == kFar) continue;
    EXPECT_EQ(world.times.at(0), time);
    EXPECT_NE(world.body.getWorldTransform().getOrigin(), before.getWorldTransform().getOrigin());
    EXPECT_NEAR(stone.getWorldTransform().getOrigin().z(), 1, 0.05);
    EXPECT_EQ(world.fluid.counters().rejected, rejected);
    EXPECT_EQ(world.said.size(), 1u);
  }
}

// Surfaces of which nothing is said but the water.

FluidRegion bareSea(const Vector3& up) {
  FluidRegion sea;
  sea.below = water();
  sea.surface = std::make_shared<StillWater>(0, up);
  return sea;
}

/// Falls from 30 m in a world whose gravity is along -z.
struct FallingBall {
  explicit FallingBall(const Medium& own) {
    world.world.setGravity({0, 0, bt(-9.81)});
    body = &world.add({20, Vector3::Constant(0.3), startAt({0, 0, 30})},
                      floatingEllipsoid(Vector3(0.2, 0.2, 0.2), 2), own);
  }
  double height() const { return static_cast<double>(body->getWorldTransform().getOrigin().z()); }

  FluidWorld world;
  btRigidBody* body = nullptr;
};

TEST(UnnamedAbove, ABodyAboveTheSeaFallsAsInItsOwnMedium) {
  for (const Medium& own : {air(), Medium{}, water()}) {
    FallingBall in_air(air()), over_sea(own), over_vacuum(own);
    over_sea.world.fluid.addRegion(bareSea({0, 0, 1}));
    FluidRegion below_vacuum = bareSea({0, 0, 1});
    below_vacuum.above = Medium{};
    over_vacuum.world.fluid.addRegion(below_vacuum);
    for (FallingBall* ball : {&in_air, &over_sea, &over_vacuum}) ball->world.step(kWorldStep, 200);
    EXPECT_EQ(over_sea.world.of(*over_sea.body).medium().density, air().density);
    EXPECT_EQ(over_sea.height(), in_air.height());
    EXPECT_LT(over_vacuum.height(), in_air.height() - 0.01) << "the drag of air is seen";
  }
}

TEST(UnnamedAbove, RegionsComeAndGo) {
  FallingBall ball(Medium{});
  const auto density = [&] {
    ball.world.step(kWorldStep);
    return ball.world.of(*ball.body).medium().density;
  };
  const RegionId sea = ball.world.fluid.addRegion(bareSea({0, 0, 1}));
  EXPECT_EQ(density(), air().density);
  ball.world.of(*ball.body).setMedium(idealFluid(0.5));
  EXPECT_EQ(density(), 0.5);
  ball.world.fluid.removeRegion(sea);
  ball.world.of(*ball.body).setMedium(Medium{});
  EXPECT_EQ(density(), 0);
  ball.world.fluid.addRegion(bareSea({0, 0, 1}));
  EXPECT_EQ(density(), air().density);
}

TEST(DirectionUp, ThatIsNotAgainstGravityIsSaidOnce) {
  for (const Vector3& up : {Vector3(0, 0, -1), Vector3(0, 1, 0), Vector3(0, 1, 0.9)}) {
    FallingBall ball(air());
    ball.world.fluid.addRegion(bareSea(up));
    ball.world.step(kWorldStep, 3);
    ASSERT_EQ(ball.world.said.size(), 1U) << up.transpose();
    EXPECT_NE(ball.world.said[0].find("region of fluid 0"), std::string::npos)
        << ball.world.said[0];
    EXPECT_NE(ball.world.said[0].find("gravity is (0, 0, -9.81) m/s^2"), std::string::npos)
        << ball.world.said[0];
  }
  for (const Vector3& up : {Vector3(0, 0, 2), Vector3(0, 0.9, 1)}) {
    FallingBall ball(air());
    ball.world.fluid.addRegion(bareSea(up));
    ball.world.step(kWorldStep, 3);
    EXPECT_TRUE(ball.world.said.empty()) << up.transpose() << ": " << ball.world.said.front();
  }
}

// Regions added and removed, with the documented rule: highest priority first; of equal priority,
// the last one added.
class ArbitraryRegions {
 public:
  void add(int id, const std::optional<RegionBounds>& bounds, int priority) {
    RegionEntry& entry = entries_[id];
    entry.id = static_cast<RegionId>(id);
    entry.region.bounds = bounds;
    entry.region.priority = priority;
    index_.add(entry);
  }
  void remove(int id) {
    index_.remove(entries_.at(id));
    entries_.erase(id);
  }
  bool has(int id) const { return entries_.count(id) > 0; }

  const RegionEntry* find(const Vector3& point, long long& asked) const {
    return index_.find(point, asked);
  }
  const RegionEntry* findOneByOne(const Vector3& point) const {
    const RegionEntry* best = nullptr;
    for (const auto& [id, entry] : entries_)
      if ((!entry.region.bounds || entry.region.bounds->hold(point)) &&
          (!best || best->rank() < entry.rank()))
        best = &entry;
    return best;
  }

 private:
  std::map<int, RegionEntry> entries_;
  RegionIndex index_;
};

// Whole numbers put points on bounds, and bounds on each other; some bounds are infinite.
RegionBounds arbitraryBounds(Arbitrary& arbitrary) {
  RegionBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const double kind = arbitrary.between(0, 10);
    bounds.lowest[axis] = std::floor(arbitrary.between(-10, 10));
    bounds.highest[axis] = bounds.lowest[axis] + std::floor(arbitrary.between(1, 8));
    if (kind < 2) bounds.lowest[axis] = -kFar;
    if (kind > 1 && kind < 3) bounds.highest[axis] = kFar;
  }
  return bounds;
}

Vector3 arbitraryPoint(Arbitrary& arbitrary) {
  Vector3 point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = std::floor(arbitrary.between(-14, 14));
  const double kind = arbitrary.between(0, 40);
  if (kind < 1) point[0] = kNotANumber;
  if (kind > 39) point[1] = kFar;
  return point;
}

TEST(RegionIndex, FindsWhatOneByOneIsFound) {
  Arbitrary arbitrary(3);
  ArbitraryRegions regions;
  int found = 0;
  long long asked = 0;
  for (int id = 0; id < 400; ++id) {
    const bool is_bounded = arbitrary.between(0, 30) > 1;
    const int priority = static_cast<int>(arbitrary.between(-2, 3));
    regions.add(id,
                is_bounded ? std::optional<RegionBounds>(arbitraryBounds(arbitrary)) : std::nullopt,
                is_bounded ? priority : -5);
    const int other = static_cast<int>(arbitrary.between(0, 1.4 * id));
    if (regions.has(other) && other != id) regions.remove(other);
    for (int i = 0; i < 40; ++i) {
      const Vector3 point = arbitraryPoint(arbitrary);
      const RegionEntry* expected = regions.findOneByOne(point);
      ASSERT_EQ(regions.find(point, asked), expected) << id << ": " << point.transpose();
      found += expected ? 1 : 0;
    }
  }
  EXPECT_GT(found, 8000);
  for (int id = 0; id < 400; ++id)
    if (regions.has(id)) regions.remove(id);
  EXPECT_EQ(regions.find({0, 0, 0}, asked), nullptr);
}

TEST(RegionIndex, ARegionThatMovesOverAndOverIsFoundWhereItIs) {
  ArbitraryRegions regions;
  for (int id = 0; id < 9; ++id)
    regions.add(id, RegionBounds{{0, 0, 1.0 * id}, {1, 1, id + 1.0}}, 0);
  long long asked = 0;
  for (int i = 0; i < 500; ++i) {
    const double x = 2 + i % 7;
    regions.remove(4);
    regions.add(4, RegionBounds{{x, 0, 0}, {x + 1, 1, 1}}, 1);
    ASSERT_EQ(regions.find({x, 0.5, 0.5}, asked), regions.findOneByOne({x, 0.5, 0.5}));
    ASSERT_EQ(regions.find({0.5, 0.5, 4.5}, asked), nullptr);
    ASSERT_EQ(regions.find({0.5, 0.5, 8.5}, asked), regions.findOneByOne({0.5, 0.5, 8.5}));
  }
  EXPECT_LT(asked, 500 * 3 * 40);  // leaves of removed regions are dropped
}

// Mean number of boxes compared with a point.
double meanAsked(int count, RegionBounds (*place)(int)) {
  ArbitraryRegions regions;
  for (int id = 0; id < count; ++id) regions.add(id, place(id), 0);
  long long asked = 0;
  const int step = std::max(1, count / 1000);
  int points = 0;
  for (int id = 0; id < count; id += step, ++points) {
    const RegionBounds box = place(id);
    Vector3 point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] =
          std::isfinite(box.highest[axis])
              ? (std::isfinite(box.lowest[axis]) ? box.lowest[axis] / 2 + box.highest[axis] / 2
                                                 : box.highest[axis] - 0.5)
              : (std::isfinite(box.lowest[axis]) ? box.lowest[axis] + 0.5 : 0);
    EXPECT_NE(regions.find(point, asked), nullptr);
  }
  return static_cast<double>(asked) / points;
}

RegionBounds inAGrid(int id) {
  const Vector3 corner(id % 22, id / 22 % 22, id / 484);
  return {corner, corner + Vector3::Ones()};
}
RegionBounds inALayer(int id) { return {{-kFar, -kFar, 1.0 * id}, {kFar, kFar, id + 1.0}}; }
RegionBounds inAShell(int id) {
  return {Vector3::Constant(-id - 1.0), Vector3::Constant(id + 1.0)};
}
RegionBounds beyond(int id) { return {{1.0 * id, -kFar, -kFar}, Vector3::Constant(kFar)}; }

// Ten regions in a list would cost up to ten comparisons.
TEST(RegionIndex, TenThousandRegionsCostSomeComparisons) {
  EXPECT_LT(meanAsked(10000, inAGrid), 60);
  EXPECT_LT(meanAsked(10000, inALayer), 60);
  EXPECT_LT(meanAsked(10000, inAShell), 60);
  EXPECT_LT(meanAsked(10000, beyond), 60);
}

}  // namespace
}  // namespace ambient::test
