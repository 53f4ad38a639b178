#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "preprocess/base/surface_form.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"

// Bodies that are not small against what moves around them, docs/theory.md section 16.
namespace ambient::test {
namespace {

const Vector3 kStickSize(1, 0.04, 0.05), kPlateSize(1, 0.8, 0.1);  // [m]

// Spins of a box after each second, in water that turns, with a spin at the start.
std::vector<double> spins(const LongCase& with, const Vector3& size, double rate, double start) {
  LongScene scene;
  scene.fluid.addRegion(turningWater(rate));
  scene.add(size, 1000, with.mover, LongScene::Freedom::kTurnsAboutZ);
  scene.setSpin(start);
  std::vector<double> result;
  for (int second = 0; second < 20; ++second) {
    scene.step(1 / with.rate, static_cast<int>(with.rate));
    result.push_back(scene.speed(LongScene::Freedom::kTurnsAboutZ));
  }
  return result;
}

// A stick is taken along as one that turns in still water is slowed down. A plate is long in two
// axes: each tells half of the turning. The error is of second order in the step: 0.003 rad/s at 60
// Hz.
TEST(AlongBody, StickAndPlateTurnWithTheirWater) {
  for (const LongCase& with : longCases())
    for (const Vector3& size : {kStickSize, kPlateSize}) {
      const std::vector<double> taken = spins(with, size, kTurning, 0);
      const std::vector<double> left = spins(with, size, 0, kTurning);
      const double error = 12 / (with.rate * with.rate) + byPrecision(0, 1e-4);
      for (std::size_t i = 0; i < taken.size(); ++i)
        EXPECT_NEAR(taken[i] + left[i], kTurning, error) << with.text() << ", second " << i;
      EXPECT_GT(taken.back(), size == kStickSize ? 0.96 * kTurning : 0) << with.text();
    }
}

// A bar of 20 m has its last 5 m in a current of 1 m/s across it. Drag balances at
// 5 (1 - v)^2 = 15 v^2, by stations at 5/18 (1 - v)^2 = 13/18 v^2.
TEST(AlongBody, ABarAtTheEdgeOfACurrentTakesItsShare) {
  const double by_stations = 1 / (1 + std::sqrt(13.0 / 5)), right = 1 / (1 + std::sqrt(3.0));
  for (const LongCase& with : longCases()) {
    LongScene scene;
    scene.fluid.addRegion(filledWith(longWater()));
    scene.fluid.addRegion(halfSpace(0, 5, longWater({0, 1, 0})));
    scene.add({20, 0.5, 0.6}, 1000, with.mover, LongScene::Freedom::kMovesAlongY);
    scene.step(1 / with.rate, static_cast<int>(20 * with.rate));
    const double found = scene.speed(LongScene::Freedom::kMovesAlongY);
    EXPECT_NEAR(found, by_stations, 0.002) << with.text();
    EXPECT_NEAR(found, right, 0.05 * right) << with.text();
  }
}

// Velocities of a bar after some steps in a sea with a flow.
Twist twistIn(const FluidRegion& region, bool has_stations) {
  FluidWorld scene;
  scene.fluid.addRegion(region);
  const Vector3 size(1.5, 0.3, 0.4);
  BodyDef def{90, boxMoments(size, 90),
              startWith({Vector3(0.3, 0.7, -0.4), Vector3(0.2, -0.1, 0.3)})};
  AttachDef attach;
  auto shape = longBox(size, 4);
  if (!has_stations) shape->uniform_mass = {};
  attach.fluid_body = shape;
  btRigidBody& body = scene.add(def);
  scene.fluid.add(body, attach);
  scene.contents.step(kWorldStep, 50);
  return ambient::velocityOf(body);
}

TEST(AlongBody, AFlowThatIsTheSameEverywhereKeepsTheBits) {
  FluidRegion region = filledWith({1000, 1e-3, {0.1, 0, 0}, {0, 0, 0}});
  region.flow = [](const Vector3&, double time) {
    return FlowSample{{0.3, 0.2 * time, 0}, {0, 0, 0}};
  };
  EXPECT_EQ(twistIn(region, true).vector(), twistIn(region, false).vector());
  region.flow = [](const Vector3& p, double) { return FlowSample{{0.3 * p.y(), 0, 0}, {0, 0, 0}}; };
  EXPECT_NE(twistIn(region, true).vector(), twistIn(region, false).vector());
}

/// Counts its samples. Its waves have a number of which it tells.
class CountedSea final : public WaterSurface {
 public:
  explicit CountedSea(double number) : number_(number) {}
  WaterSample sample(const Vector3& point_W, double) const noexcept override {
    ++count;
    return {-point_W.z(), {0, 0, 0}, {0, 0, 0}};
  }
  double waveNumber() const noexcept override { return number_; }
  mutable int count = 0;

 private:
  double number_;
};

TEST(AlongBody, ABodyIsSampledAtOnePlaceWhereItIsSmallAgainstTheWaves) {
  // The axis of 0.29 m is shorter than a fifth of that of 1.5 m, the axis of 0.31 m is not.
  const Vector3 size(1.5, 0.31, 0.29);
  const auto samples = [&size](double number) {
    FluidWorld scene;
    const auto sea = std::make_shared<CountedSea>(number);
    FluidRegion region = filledWith(longWater());
    region.surface = sea;
    scene.fluid.addRegion(region);
    AttachDef attach{longBox(size)};
    scene.fluid.add(scene.add({60, boxMoments(size, 60), {}, nullptr}), attach);
    const int before = sea->count;
    scene.step(kWorldStep);
    return sea->count - before;
  };
  EXPECT_EQ(samples(0.29 / 1.5), 1);
  EXPECT_EQ(samples(0.31 / 1.5), 3);
  EXPECT_EQ(samples(0.31 / 0.31), 5);
}

// A float of 8 m as one body, or as two halves on a rigid joint.
const Vector3 kFloat(8, 2, 1);  // [m]
constexpr double kFloatMass = 500 * 16;
constexpr double kWaveNumber = 0.25, kWaveHeight = 0.1;  // k L = 2

/// The half of the float, or the whole with the added mass of its halves. The law of waves that
/// bodies make differs with the size of the body: none are made.
AttachDef floatDef(int parts) {
  const Vector3 half(kFloat.x() / 2, kFloat.y(), kFloat.z());
  AttachDef def;
  auto shape = longBox(parts == 2 ? half : kFloat, 8);
  if (parts == 1) {
    shape->added_mass.setZero();
    const Matrix6 of_half = longBox(half)->added_mass;
    for (const double x : {-half.x() / 2, half.x() / 2})
      shape->added_mass += FrameOffset{Matrix3::Identity(), {x, 0, 0}}.inertiaToB(of_half);
    makeSurfaceForm(*shape);
  }
  def.fluid_body = shape;
  def.flow.law = PressureLaw::kForm;
  def.wave_damping = 0;
  return def;
}

struct FloatScene : RobotWorld {
  FloatScene(int parts, Mover mover) {
    world.setGravity({0, 0, bt(-9.81)});
    FluidRegion sea = filledWith(longWater());
    sea.above = Medium{};
    const double period = 2 * kPi / std::sqrt(9.81 * kWaveNumber);
    sea.surface = std::make_shared<AiryWaves>(
        CalmSea{}, std::vector<WaveComponent>{{kWaveHeight, period, {1, 0, 0}, 0}});
    fluid.addRegion(sea);
    const Vector3 size(kFloat.x() / parts, kFloat.y(), kFloat.z());
    const double mass = kFloatMass / parts, apart = kFloat.x() / 2;
    const btVector3 moments = toBullet(boxMoments(size, mass));
    const AttachDef def = floatDef(parts);
    if (mover == Mover::kRigid) {
      for (int i = 0; i < parts; ++i) {
        const btVector3 place(bt(parts == 2 ? (i - 0.5) * apart : 0), 0, 0);
        btRigidBody& body =
            contents.add(mass, moments, no_shape_, btTransform(btQuaternion::getIdentity(), place));
        body.setActivationState(DISABLE_DEACTIVATION);
        fluid.add(body, def);
        bodies.push_back(&body);
      }
      if (parts == 2) {
        const btVector3 half(bt(apart / 2), 0, 0);
        contents.join(std::make_unique<btFixedConstraint>(
            *bodies[0], *bodies[1], btTransform(btQuaternion::getIdentity(), half),
            btTransform(btQuaternion::getIdentity(), -half)));
      }
      return;
    }
    auto robot = std::make_unique<btMultiBody>(parts - 1, bt(mass), moments, false, false);
    if (parts == 2)
      robot->setupFixed(0, bt(mass), moments, -1, btQuaternion::getIdentity(),
                        {bt(apart / 2), 0, 0}, {bt(apart / 2), 0, 0});
    robot->finalizeMultiDof();
    robot->setBasePos({bt(parts == 2 ? -apart / 2 : 0), 0, 0});
    tree = &takeUndamped(std::move(robot));
    for (int link = -1; link < parts - 1; ++link) fluid.add(*tree, link, def);
  }
  /// Height of the middle [m] and pitch, down at the end ahead [rad].
  Eigen::Vector2d motion() const {
    if (tree) {
      const btQuaternion q = tree->getWorldToBaseRot().inverse();
      const Vector3 x = toVector3(quatRotate(q, {1, 0, 0}));
      const double way = tree->getNumLinks() > 0 ? kFloat.x() / 4 : 0;
      return {static_cast<double>(tree->getBasePos().z()) + way * x.z(), -x.z()};
    }
    double height = 0;
    for (const btRigidBody* body : bodies)
      height += static_cast<double>(body->getWorldTransform().getOrigin().z());
    return {height / static_cast<double>(bodies.size()),
            -static_cast<double>(bodies[0]->getWorldTransform().getBasis()[2].x())};
  }

  std::vector<btRigidBody*> bodies;
  btMultiBody* tree = nullptr;

 private:
  btEmptyShape no_shape_;
};

// Amplitudes of heave over that of the wave, and of pitch over its slope, from the fifth period to
// the tenth.
Eigen::Vector2d amplitudes(int parts, const LongCase& with) {
  FloatScene scene(parts, with.mover);
  const double frequency = std::sqrt(9.81 * kWaveNumber);
  const int steps = static_cast<int>(10 * 2 * kPi / frequency * with.rate);
  Eigen::Matrix<double, 5, 5> squares = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 2> sums = Eigen::Matrix<double, 5, 2>::Zero();
  for (int i = 1; i <= steps; ++i) {
    scene.step(1 / with.rate);
    if (i < steps / 2) continue;
    const double angle = frequency * i / with.rate;
    Eigen::Matrix<double, 5, 1> row;
    row << 1, i / static_cast<double>(steps), std::cos(angle), std::sin(angle),
        i * i / double(steps) / double(steps);
    squares += row * row.transpose();
    sums += row * scene.motion().transpose();
  }
  const Eigen::Matrix<double, 5, 2> fit = squares.ldlt().solve(sums);
  return {fit.block<2, 1>(2, 0).norm() / kWaveHeight,
          fit.block<2, 1>(2, 1).norm() / (kWaveHeight * kWaveNumber)};
}

TEST(AlongBody, TwoHalvesOnARigidJointMoveInWavesAsTheWhole) {
  for (const Mover mover : kMovers)
    for (const double rate : {30.0, 60.0, 240.0}) {
      const LongCase with{mover, rate};
      const Eigen::Vector2d one = amplitudes(1, with), two = amplitudes(2, with);
      EXPECT_NEAR(two[0] / one[0], 1, 0.03) << with.text() << ", heave";
      EXPECT_NEAR(two[1] / one[1], 1, 0.03) << with.text() << ", pitch";
    }
}

// Of the velocity of a wave along a bar with the mean of a cosine, sin x / x, x = k L / 2 = 1.
TEST(AlongBody, AFloatFeelsTheMeanOfAWave) {
  FloatScene scene(1, Mover::kRigid);
  scene.step(1.0 / 60);
  const Medium water = scene.fluid.find(*scene.bodies[0])->medium();
  const double speed = kWaveHeight * std::sqrt(9.81 * kWaveNumber);
  EXPECT_NEAR(water.velocity.x() / speed, std::sin(1.0), 1e-4);
  EXPECT_NEAR(water.acceleration.z() / (-9.81 * kWaveNumber * kWaveHeight), std::sin(1.0), 1e-4);
}

}  // namespace
}  // namespace ambient::test
