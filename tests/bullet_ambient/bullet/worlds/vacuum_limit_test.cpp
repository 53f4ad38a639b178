#include <gtest/gtest.h>

#include <cmath>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/kirchhoff_integration.h"
#include "tests/support/matrices.h"

// Motion in thin fluid tends to motion in a vacuum, at first order in the density.
namespace ambient::test {
namespace {

constexpr int kLimitSteps = 60;
// Offset from the centre of mass couples the added mass.
AttachDef inFluid(double density) {
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid(kUnequalAxes, 1));
  def.medium = {density, 1.5e-5 * density, Vector3(0.5, 0, 0), Vector3::Zero()};
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
    BodyDef def{1, Vector3(0.04, 0.05, 0.07), {}, nullptr};
    def.start.twist = {Vector3(1, 2, 3), Vector3(2, 1, 3)};
    return def;
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
  btPoint2PointConstraint joint(run.body, btVector3(0, static_cast<btScalar>(0.1), 1));
  run.scene.world.addConstraint(&joint);
  run.scene.step(step, static_cast<int>(std::lround(kLimitSteps * kWorldStep / step)));
  run.scene.world.removeConstraint(&joint);
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

}  // namespace
}  // namespace ambient::test
