#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/conversions.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/worlds/vacuum_scene.h"
#include "tests/reference/kirchhoff_motion.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/matrices.h"

namespace ambient::test {
namespace {

// Dry bodies must move bit for bit like stock Bullet, in any world and with any solver.

constexpr int kStepsBetween = 50;

// Fluid body with half of the density at which the body floats.
AttachDef inThinFluid() {
  AttachDef def{std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.5, 0.4, 0.3), 1))};
  def.medium.density = 2;
  return def;
}

void expectSameBits(VacuumScene& stock, VacuumScene& ambient, int steps) {
  for (int step = 0; step < steps; step += kStepsBetween) {
    stock.step(kStepsBetween);
    ambient.step(kStepsBetween);
    const auto a = stock.state(), b = ambient.state();
    const auto differing = std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin();
    ASSERT_TRUE(sameBits(a, b)) << "number " << differing << " of " << a.size() << " after step "
                                << step + kStepsBetween;
  }
  EXPECT_GT(stock.ballTravel(), 1);  // the ball moves
}

// Tells if the setup needs one group per island. Conjugate gradients and complementarity solvers
// couple all rows of a group, so islands merged into a group act on each other.
bool needsOneIslandPerGroup(const WorldSetup& setup) {
  const auto is_used = [&](const char* solver) { return usesSolver(setup, solver); };
  return is_used("ConjugateGradient") || is_used("Dantzig") || is_used("ProjectedGaussSeidel") ||
         is_used("Lemke");
}

/// Equal scenes with Bullet's solver and with the ambient one.
struct ScenePair {
  explicit ScenePair(const WorldSetup& setup)
      : stock(setup.make(false)), ambient(setup.make(true)) {
    if (!needsOneIslandPerGroup(setup)) return;
    for (VacuumScene* scene : {&stock, &ambient})
      scene->host().world().getSolverInfo().m_minimumSolverBatchSize = 1;
  }
  /// Adds softness for Lemke's solver, which inverts the matrix of all rows. A box on a floor has
  /// dependent rows: four contacts have more rows than degrees of freedom. Without softness
  /// rounding throws the box into other bodies.
  void softenIfSingular(const WorldSetup& setup) {
    if (!usesSolver(setup, "Lemke")) return;
    for (VacuumScene* scene : {&stock, &ambient})
      scene->host().world().getSolverInfo().m_globalCfm = static_cast<btScalar>(1e-3);
  }
  VacuumScene stock, ambient;
};

class StockMotion : public testing::TestWithParam<WorldSetup> {};
INSTANTIATE_TEST_SUITE_P(Of, StockMotion, testing::ValuesIn(allWorlds()), nameOf);

TEST_P(StockMotion, OfAWorldWithoutAmbientBodiesIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  expectSameBits(scenes.stock, scenes.ambient, 1000);
}

TEST_P(StockMotion, OfBodiesBesideAFlyingAmbientOneIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  Fluid& fluid = scenes.ambient.host().fluid();
  for (VacuumScene* scene : {&scenes.stock, &scenes.ambient}) {
    btRigidBody& body = scene->addAside({0, 0, 500});
    body.setAngularVelocity({1, 2, 3});
    if (scene == &scenes.ambient) fluid.add(body, inThinFluid());
  }
  expectSameBits(scenes.stock, scenes.ambient, 500);
  EXPECT_GT(fluid.counters().load_evaluations, 0);
}

TEST_P(StockMotion, OfBodiesInAFluidOfDensityZeroIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  AttachDef def = inThinFluid();
  def.medium.density = 0;
  Fluid& fluid = scenes.ambient.host().fluid();
  for (btRigidBody* body : scenes.ambient.bodies()) fluid.add(*body, def);
  expectSameBits(scenes.stock, scenes.ambient, 500);
  EXPECT_EQ(fluid.counters().rows, 0);
  EXPECT_EQ(fluid.counters().load_evaluations, 0);
}

TEST_P(StockMotion, ReturnsWhenABodyIsDetached) {
  ScenePair scenes(GetParam());
  Fluid& fluid = scenes.ambient.host().fluid();
  btRigidBody& body = *scenes.ambient.bodies()[2];
  fluid.add(body, inThinFluid());
  EXPECT_TRUE(fluid.find(body)->remove());
  EXPECT_FALSE(fluid.find(body));
  expectSameBits(scenes.stock, scenes.ambient, 500);
}

TEST_P(StockMotion, OfBodiesBesideAnAmbientOneThatSlidesIsKeptBitForBit) {
  ScenePair scenes(GetParam());
  scenes.softenIfSingular(GetParam());
  Fluid& fluid = scenes.ambient.host().fluid();
  for (VacuumScene* scene : {&scenes.stock, &scenes.ambient}) {
    btRigidBody& body = scene->addAside({30, 30, static_cast<btScalar>(0.5)});
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setLinearVelocity({2, 1, 0});
    body.setAngularVelocity({0, 0, 3});
    if (scene == &scenes.ambient) fluid.add(body, inThinFluid());
  }
  expectSameBits(scenes.stock, scenes.ambient, 1000);
  EXPECT_GT(fluid.counters().rows, 500);
}

// Motion in thin fluid tends to motion in a vacuum, at first order in the density.

constexpr int kLimitSteps = 60;
// Offset from the centre of mass couples the added mass.
AttachDef inFluid(double density) {
  AttachDef def{std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1)),
                {density, 1.5e-5 * density, Vector3(0.5, 0, 0), Vector3::Zero()}};
  def.fluid_frame.translation = Vector3(0.05, 0.03, -0.02);
  return def;
}

struct Run {
  FluidWorld scene;
  btRigidBody& body;

  explicit Run(double density) : body(scene.add(start())) {
    scene.world.setGravity({0, 0, static_cast<btScalar>(-9.81)});
    scene.world.removeRigidBody(&body);
    scene.world.addRigidBody(&body);  // takes the world's gravity
    if (density > 0) scene.fluid.add(body, inFluid(density));
  }
  static BodyDef start() {
    return {1, Vector3(0.04, 0.05, 0.07), startWith({Vector3(1, 2, 3), Vector3(2, 1, 3)})};
  }
  Vector6 velocity() const {
    return stack(toVector3(body.getAngularVelocity()), toVector3(body.getLinearVelocity()));
  }
};

template <class Simulate>
void expectFirstOrder(const Simulate& simulate, const Vector6& vacuum) {
  // float32 rounds velocities to 6e-8 in each step.
  const double thin = kDouble ? 1e-5 : 1e-2;
  double error[3];
  for (int k = 0; k < 3; ++k) error[k] = (simulate(thin * std::pow(4, k)) - vacuum).norm();
  for (int k = 1; k < 3; ++k) {
    const double order = std::log(error[k] / error[k - 1]) / std::log(4);
    EXPECT_NEAR(order, 1, 0.1);
  }
}

// Euler's equations and a parabola; Bullet's own flight of a spinning body has first order.
Vector6 exactFlight() {
  const BodyDef def = Run::start();
  const double duration = kLimitSteps * kWorldStep;
  Eigen::Matrix<double, 6, 6> inertia = Eigen::Matrix<double, 6, 6>::Identity();
  inertia.diagonal().head<3>() = def.moments;
  reference::KirchhoffState s = reference::KirchhoffState::Zero();
  s[3] = 1;
  s.segment<3>(7) = def.moments.cwiseProduct(def.start.twist.angular);
  s = reference::integrate({inverse(inertia)}, s, duration, 60);
  const Vector3 spin =
      reference::orientationOf(s) * Eigen::Vector3d(s.segment<3>(7).cwiseQuotient(def.moments));
  return stack(spin, def.start.twist.linear + duration * Vector3(0, 0, -9.81));
}

Vector6 flight(double density) {
  Run run(density);
  run.scene.step(kWorldStep, kLimitSteps);
  return run.velocity();
}

Vector6 swing(double density, double step) {
  Run run(density);
  run.body.setFlags(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT);
  run.scene.contents.take(std::make_unique<btPoint2PointConstraint>(
      run.body, btVector3(0, static_cast<btScalar>(0.1), 1)));
  run.scene.step(step, static_cast<int>(std::lround(kLimitSteps * kWorldStep / step)));
  return run.velocity();
}

TEST(VacuumLimit, OfFreeFlightIsReachedAtFirstOrder) { expectFirstOrder(flight, exactFlight()); }

Vector6 pendulum(double density) { return swing(density, kWorldStep); }

constexpr double kThinnest = 1e-12;

TEST(VacuumLimit, OfAPendulumIsReachedAtFirstOrder) {
  expectFirstOrder(pendulum, pendulum(kThinnest));
}

// Both pendulums have first order in the step.
TEST(VacuumLimit, OfAPendulumIsThatOfStockBulletTheShorterTheStep) {
  double difference[4];
  for (int k = 0; k < 4; ++k) {
    const double step = kWorldStep / (1 << k);
    difference[k] = (swing(kThinnest, step) - swing(0, step)).norm();
  }
  for (int k = 1; k < 4; ++k) EXPECT_LT(difference[k], 0.6 * difference[k - 1]) << k;
}

// A fluid without inertia or volume, through the full 6x6 path. Each step from a state of stock
// Bullet must end like stock Bullet, to rounding.

constexpr int kSteps = 300;
constexpr double kVacuumTolerance = kDouble ? 3e-15 : 3e-7;
// In float Bullet turns a body with eight roundings, this library in double with one.
constexpr double kPoseTolerance = kDouble ? 3e-15 : 1e-6;
// A ball that hits a stack: rows amplify rounding. Measured: 1.5e-14, 3e-7.
constexpr double kStackTolerance = kDouble ? 3e-14 : 1e-6;

// Tells if the moments are equal. Other bodies turn differently from Bullet and stay dry here.
bool isRound(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  return inverse.x() == inverse.y() && inverse.y() == inverse.z();
}

AttachDef nothingButThePath() {
  AttachDef def;
  auto fluid_body = std::make_shared<FluidBody>();
  fluid_body->name = "nothing";
  fluid_body->area = 1;
  def.fluid_body = fluid_body;
  def.medium.density = 1;
  return def;
}

double speed(const btRigidBody& body) {
  return static_cast<double>(
      std::max(body.getLinearVelocity().length(), body.getAngularVelocity().length()));
}

double velocityDifference(const btRigidBody& a, const btRigidBody& b) {
  return static_cast<double>(std::max((a.getLinearVelocity() - b.getLinearVelocity()).length(),
                                      (a.getAngularVelocity() - b.getAngularVelocity()).length()));
}

// Difference of place. A body without contacts flies along a parabola; Bullet moves it by the
// velocity of the step's end.
double placeDifference(const btRigidBody& stock, const btRigidBody& ambient) {
  const Vector3 place = toVector3(stock.getWorldTransform().getOrigin());
  const Vector3 difference = toVector3(ambient.getWorldTransform().getOrigin()) - place;
  const Vector3 parabola(0, 0, 9.81 / 2 * kWorldStep * kWorldStep);
  return std::min(difference.norm(), (difference - parabola).norm()) / std::max(1.0, place.norm());
}

double turnDifference(const btRigidBody& a, const btRigidBody& b) {
  double sum = 0;
  for (int row = 0; row < 3; ++row)
    sum += static_cast<double>(
        (a.getWorldTransform().getBasis()[row] - b.getWorldTransform().getBasis()[row]).length2());
  return std::sqrt(sum);
}

class VacuumStep : public testing::TestWithParam<WorldSetup> {
 protected:
  VacuumStep() {
    for (VacuumScene* scene : {&stock_, &ambient_}) {
      if (isPivoting()) scene->host().world().getSolverInfo().m_minimumSolverBatchSize = 1;
      for (btRigidBody* body : scene->bodies()) {
        // Explicit form of Bullet's gyroscopic torque, equal to the one in the rows' velocity.
        body->setFlags(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT);
        // A bounce in a fluid is another one, docs/theory.md eq. (28e). With Lemke's solver, which
        // leaves few rows, nothing bounces; else what does stays Bullet's.
        if (usesSolver(GetParam(), "Lemke")) body->setRestitution(0);
        if (scene == &ambient_ && isRound(*body) && body->getRestitution() == 0)
          ambient_.host().fluid().add(*body, nothingButThePath());
      }
    }
  }
  // Tells if the solver pivots. Impulses of a box on four contacts are not unique: pivoting solvers
  // find others after a rounding, also without fluid.
  static bool isPivoting() {
    return usesSolver(GetParam(), "Dantzig") || usesSolver(GetParam(), "Lemke");
  }
  void compare() {
    if (!isPivoting()) compare(stock_.bodies(), ambient_.bodies(), velocity_error_);
    compare(stock_.jointed(), ambient_.jointed(), jointed_velocity_error_);
  }
  void compare(const std::vector<btRigidBody*>& stock, const std::vector<btRigidBody*>& ambient,
               double& velocity_error) {
    double fastest = 1;
    for (const btRigidBody* body : stock) fastest = std::max(fastest, speed(*body));
    for (std::size_t i = 0; i < stock.size(); ++i) {
      velocity_error =
          std::max(velocity_error, velocityDifference(*stock[i], *ambient[i]) / fastest);
      pose_error_ = std::max({pose_error_, placeDifference(*stock[i], *ambient[i]),
                              turnDifference(*stock[i], *ambient[i])});
    }
  }

  VacuumScene stock_{GetParam().make(false)};
  VacuumScene ambient_{GetParam().make(true)};
  double velocity_error_ = 0, jointed_velocity_error_ = 0, pose_error_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Of, VacuumStep, testing::ValuesIn(allWorlds()), nameOf);

TEST_P(VacuumStep, EndsAsInStockBullet) {
  for (int step = 0; step < kSteps; ++step) {
    stock_.step(1);
    ambient_.step(1);
    compare();
    ambient_.takeStateOf(stock_);
  }
  // Lemke's solver may throw the stack apart in stock Bullet; joints remain.
  const int rows_per_step = usesSolver(GetParam(), "Lemke") ? 1 : 10;
  EXPECT_GT(ambient_.host().fluid().counters().rows, rows_per_step * kSteps);
  EXPECT_LT(velocity_error_, kStackTolerance);
  EXPECT_LT(jointed_velocity_error_, kVacuumTolerance);
  EXPECT_LT(pose_error_, kPoseTolerance);
}

}  // namespace
}  // namespace ambient::test
