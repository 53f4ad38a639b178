#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/bullet/fluid_world.h"
#include "tests/reference/kirchhoff_integration.h"
#include "tests/reference/kirchhoff_motion.h"
#include "tests/support/random_bodies.h"

// Exact motions of an ideal fluid without loads, through stepSimulation of a stock world.
namespace ambient::test {
namespace {

const Vector3 kSemiAxes{0.3, 0.2, 0.1};
const Medium kIdeal{1000, 0, Vector3::Zero(), Vector3::Zero()};

// Neutrally buoyant homogeneous ellipsoid: total translational and rotational inertias.
struct NeutralEllipsoid {
  double mass = kIdeal.density * ellipsoidVolume(kSemiAxes);
  Vector3 moments = ellipsoidMoments(kSemiAxes, mass);
  FluidBody shape = facelessEllipsoid(kSemiAxes);
  Vector3 total_moments = moments + kIdeal.density * shape.added_mass.diagonal().head<3>();
  Vector3 masses = Vector3::Constant(mass) + kIdeal.density * shape.added_mass.diagonal().tail<3>();
};

double yaw(const btRigidBody& body) {
  const btVector3 x = body.getWorldTransform().getBasis().getColumn(0);
  return std::atan2(static_cast<double>(x.y()), static_cast<double>(x.x()));
}

// Momentum P = 2 m along -x of the world and the short axis (y) at `angle` from it, at rest in
// rotation.
btRigidBody& addRocking(FluidWorld& fluid, const NeutralEllipsoid& e, double angle) {
  BodyDef def{e.mass, e.moments, {}, nullptr};
  const double turn = std::acos(-1.0) / 2 + angle;  // body y along -x of the world, then tilted
  def.start.orientation = Quaternion(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
  const Vector3 momentum = 2 * e.mass * Vector3(-1, 0, 0);
  const Vector3 in_body = def.start.orientation.conjugate() * momentum;
  def.start.twist.linear = def.start.orientation * Vector3(in_body.cwiseQuotient(e.masses));
  return fluid.add(def, e.shape, kIdeal);
}

// Time between the first and the third passage through theta = 0, interpolated.
double measuredPeriod(FluidWorld& fluid, const btRigidBody& body, double dt) {
  const double middle = std::acos(-1.0) / 2;
  double first = -1, before = yaw(body) - middle;
  int passages = 0;
  for (int i = 1; i < 100000; ++i) {
    fluid.step(dt);
    const double now = yaw(body) - middle;
    if (before * now < 0) {
      const double time = dt * (i - now / (now - before));
      if (passages++ == 0) first = time;
      if (passages == 3) return time - first;
    }
    before = now;
  }
  return 0;
}

TEST(KirchhoffInWorld, RocksWithThePeriodOfTheEllipticIntegral) {
  // Frequency and periods of an independent evaluation: Omega = 4.011300635271759; amplitude,
  // period [s].
  const double kPeriods[][2] = {
      {0.1, 1.57029600502}, {0.5, 1.670275123599}, {1.0, 2.0815575012}, {1.4, 3.165329064944}};
  const NeutralEllipsoid e;
  const auto motion = reference::PlanarMotion::of(e.masses, e.total_moments.z(), 2 * e.mass);
  EXPECT_NEAR(motion.frequency, 4.011300635271759, 1e-10);
  for (const auto& [amplitude, period] : kPeriods) {
    EXPECT_NEAR(motion.rockingPeriod(amplitude), period, 1e-9);
    for (const double dt : {1.0 / 60, 1.0 / 240}) {
      FluidWorld fluid;
      const btRigidBody& body = addRocking(fluid, e, amplitude);
      // Interpolating the passages linearly costs (Omega dt)^2 / 10 of a step.
      const double interpolation = dt * std::pow(motion.frequency * dt, 2);
      EXPECT_NEAR(measuredPeriod(fluid, body, dt), period, interpolation + byPrecision(1e-8, 2e-4))
          << "amplitude " << amplitude << ", step " << dt;
    }
  }
}

TEST(KirchhoffInWorld, MunksMomentTurnsABodyAwayFromItsUnstableAxis) {
  const NeutralEllipsoid e;
  // Along the longest axis with 1 m/s. Growth about y and z of an independent evaluation [1/s^2].
  const reference::TranslationAlongAxis motion{e.masses, e.total_moments, 1.0};
  EXPECT_NEAR(motion.growth(0, 1), 17.280202446074586, 1e-9);
  EXPECT_NEAR(motion.growth(0, 2), 5.651126831285162, 1e-9);
  const double lambda = std::sqrt(motion.growth(0, 2));
  const double tilt = 1e-3;
  BodyDef def{e.mass, e.moments, {}, nullptr};
  def.start.orientation = Quaternion(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitZ()));
  const Vector3 momentum = e.masses.x() * Vector3(1, 0, 0);
  const Vector3 in_body = def.start.orientation.conjugate() * momentum;
  def.start.twist.linear = def.start.orientation * Vector3(in_body.cwiseQuotient(e.masses));
  FluidWorld fluid;
  const btRigidBody& body = fluid.add(def, e.shape, kIdeal);
  const double dt = 1.0 / 60, time = 0.5;
  fluid.step(dt, 30);
  const double expected = tilt * std::cosh(lambda * time);
  // sin(theta) cos(theta) = theta (1 - 2/3 theta^2): the linear growth holds to 2/3 theta^2.
  EXPECT_NEAR(yaw(body) / expected, 1, 2.0 / 3 * expected * expected + byPrecision(1e-6, 2e-4));
}

TEST(KirchhoffInWorld, TumblesHalfATurnInTheTimeOfTheEllipticIntegral) {
  const NeutralEllipsoid e;
  const auto motion = reference::PlanarMotion::of(e.masses, e.total_moments.z(), 2 * e.mass);
  const double rate = 1.5 * motion.frequency;
  const double half_turn = motion.tumblingHalfTurn(rate);
  for (const int steps : {30, 120}) {
    FluidWorld fluid;
    btRigidBody& body = addRocking(fluid, e, 0);
    body.setAngularVelocity(toBullet(Vector3(0, 0, rate)));
    const double begin = yaw(body);
    fluid.step(half_turn / steps, steps);
    const double turned = std::remainder(yaw(body) - begin - std::acos(-1.0), 2 * std::acos(-1.0));
    EXPECT_NEAR(turned, 0, byPrecision(1e-9, 1e-4)) << steps << " steps";
    EXPECT_NEAR(static_cast<double>(body.getAngularVelocity().z()), rate,
                rate * byPrecision(1e-9, 1e-4));
  }
}

// Random positive definite K with coupling, 120 rad of turning at most, against an independent
// integration of order 16.
TEST(KirchhoffInWorld, SpinningCoupledBodiesFollowTheExactMotion) {
  Arbitrary arbitrary(7);
  for (const double spin : {6.0, 20.0, 60.0, 200.0}) {
    BodyDef def{2.0, Vector3(0.7, 0.9, 1.1), {}, nullptr};
    FluidBody shape = facelessEllipsoid(Vector3::Constant(0.5));
    shape.added_mass = arbitrary.positiveDefinite();
    def.start.twist.angular = arbitrary.vector().normalized() * spin;
    def.start.twist.linear = arbitrary.vector();
    const Medium medium{1, 0, Vector3::Zero(), Vector3::Zero()};
    FluidWorld fluid;
    const btRigidBody& body = fluid.add(def, shape, medium);
    const Matrix6 K = fluid.registry.inertia(body);
    reference::KirchhoffState s;
    s << 0, 0, 0, 1, 0, 0, 0, K * readState(body).twist.vector();
    const int steps = std::min(120, static_cast<int>(60 * 120 / spin));
    const double dt = 1.0 / 60, duration = steps * dt;
    fluid.step(dt, steps);
    s = reference::integrate({K.inverse()}, s, duration, static_cast<int>(60 * spin));
    const Quaternion reached = readState(body).orientation;
    const double error =
        2 * (reached.conjugate() * Quaternion(reference::orientationOf(s))).vec().norm();
    // float32: the state itself is rounded 120 times, and the motion stretches the error.
    EXPECT_LT(error, byPrecision(1e-9, 4e-6) * spin * duration * 60) << spin << " rad/s";
  }
}

TEST(KirchhoffInWorld, WorldMomentumAndEnergyStay) {
  Arbitrary arbitrary(11);
  BodyDef def{2.0, Vector3(0.7, 0.9, 1.1), {}, nullptr};
  FluidBody shape = facelessEllipsoid(Vector3::Constant(0.5));
  shape.added_mass = arbitrary.positiveDefinite();
  def.start.twist = arbitrary.twist(10, 2);
  FluidWorld fluid;
  const btRigidBody& body = fluid.add(def, shape, {1, 0, Vector3::Zero(), Vector3::Zero()});
  const Matrix6 K = fluid.registry.inertia(body);
  const auto conserved = [&] {
    const RigidState s = readState(body);
    const Momentum m = Momentum::fromVector(K * s.twist.vector());
    const Vector3 P = s.orientation * m.linear;
    Eigen::Matrix<double, 7, 1> all;
    all << P, s.orientation * m.angular + s.position.cross(P),
        s.twist.vector().dot(K * s.twist.vector());
    return all;
  };
  const auto before = conserved();
  fluid.step(1.0 / 60, 600);
  EXPECT_LT((conserved() - before).norm(), byPrecision(1e-10, 2e-3) * before.norm());
}

}  // namespace
}  // namespace ambient::test
