#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/solver/fluid_solver.h"
#include "bullet_ambient/fluid.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/elliptic.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

// Pendulums with coupled K in a stock world. The joint allows one twist s = (z, z x r), constant in
// body axes. So the body is a plane pendulum of inertia s.K s for every K.
namespace ambient::test {
namespace {

constexpr double kLength = 1;  // pivot to centre of mass [m]
constexpr double kMass = 2;    // [kg]
const Vector3 kMoments{0.3, 0.4, 0.2};

/// Suspension: point or hinge of the world, or point of a btMultiBody at rest.
enum class Suspension { kPoint, kHinge, kLink };

/// K of a body symmetric about the plane of the swing: no moment drives the body out of the plane,
/// where a point joint would let it go.
Matrix6 symmetricAboutPlane(Matrix6 K) {
  Vector6 mirror;
  mirror << -1, -1, 1, 1, 1, -1;
  return (K + mirror.asDiagonal() * K * mirror.asDiagonal()) / 2;
}

/// Pendulum below the origin of the world.
struct Pendulum {
  Suspension suspension = Suspension::kHinge;
  Matrix6 added_mass = Matrix6::Zero();  // fluid of density 1
  Quaternion hanging = Quaternion::Identity();
  double amplitude = 0;

  static Pendulum random(Suspension suspension, unsigned seed, double amplitude) {
    Arbitrary arbitrary(seed);
    Pendulum p;
    p.suspension = suspension;
    p.amplitude = amplitude;
    p.added_mass = 0.5 * arbitrary.positiveDefinite();
    if (suspension != Suspension::kHinge) {
      p.added_mass = symmetricAboutPlane(p.added_mass);
    } else {
      p.hanging = Quaternion(arbitrary.rotation());
    }
    return p;
  }

  RigidState start() const {
    const Quaternion turn(Eigen::AngleAxisd(amplitude, Eigen::Vector3d::UnitZ()));
    RigidState state;
    state.orientation = turn * hanging;
    state.position = turn * Vector3(0, -kLength, 0);
    return state;
  }
  Vector3 pivot() const { return hanging.conjugate() * Vector3(0, kLength, 0); }  ///< body axes
  Vector3 axis() const { return hanging.conjugate() * Vector3::UnitZ(); }
  double angle(const btRigidBody& body) const {
    const Vector3 x = readState(body).orientation * hanging.conjugate() * Vector3::UnitX();
    return std::atan2(x.y(), x.x());
  }
  double inertia() const {
    Matrix6 K = added_mass;
    K.topLeftCorner<3, 3>() += kMoments.asDiagonal();
    K.bottomRightCorner<3, 3>() += kMass * Matrix3::Identity();
    const Vector6 s = stack(axis(), axis().cross(-pivot()));
    return s.dot(K * s);
  }
  double period() const {
    const double frequency = std::sqrt(kMass * kGravity * kLength / inertia());
    return 4 / frequency * reference::completeEllipticK(std::sin(amplitude / 2));
  }
};

constexpr int kPeriods = 10;
constexpr double kBulletsCorrection = 0.2;

// `correction`: part of the joint's error corrected per step.
class SwingingWorld : TreeWorld {
 public:
  SwingingWorld(const Pendulum& pendulum, double correction) {
    world.setGravity({0, btScalar(-kGravity), 0});
    world.getSolverInfo().m_erp = btScalar(correction);
    world.getSolverInfo().m_numIterations = 200;
    const RigidState start = pendulum.start();
    body_ = &contents.add(kMass, toBullet(kMoments), no_shape_,
                          btTransform(toBullet(start.orientation), toBullet(start.position)));
    body_->setActivationState(DISABLE_DEACTIVATION);
    AttachDef def;
    def.fluid_body = std::make_shared<FluidBody>(shapeWithoutFaces(pendulum.added_mass, 0));
    def.medium = {1, 0, Vector3::Zero(), Vector3::Zero()};
    fluid_.add(*body_, def);
    hang(pendulum);
  }

  const btRigidBody& body() const { return *body_; }
  using TreeWorld::step;

 private:
  void hang(const Pendulum& pendulum) {
    const btVector3 pivot = toBullet(pendulum.pivot());
    switch (pendulum.suspension) {
      case Suspension::kPoint:
        contents.take(std::make_unique<btPoint2PointConstraint>(*body_, pivot));
        break;
      case Suspension::kHinge:
        contents.take(
            std::make_unique<btHingeConstraint>(*body_, pivot, toBullet(pendulum.axis())));
        break;
      case Suspension::kLink:
        contents.take(std::make_unique<btMultiBodyPoint2Point>(&addGround(), -1, body_,
                                                               btVector3(0, 0, 0), pivot));
    }
  }
  btMultiBody& addGround() {
    auto ground = std::make_unique<btMultiBody>(0, btScalar(1), btVector3(1, 1, 1), true, false);
    ground->finalizeMultiDof();
    contents.addCollider(*ground, -1, no_shape_);
    return contents.take(std::move(ground));
  }

  Fluid fluid_{world};
  btEmptyShape no_shape_;
  btRigidBody* body_;
};

struct Swing {
  double period;     // mean of ten
  double amplitude;  // during the last period
};

Swing measure(const Pendulum& pendulum, double correction, double dt) {
  SwingingWorld world(pendulum, correction);
  double first = 0, before = pendulum.angle(world.body()), amplitude = 0;
  int passages = 0;
  for (int i = 1; i < 100000; ++i) {
    world.step(dt);
    const double now = pendulum.angle(world.body());
    if (before * now < 0) {
      // Acceleration is 0 here: linear interpolation has an error of third order in the step.
      const double time = dt * (i - now / (now - before));
      if (passages == 0) first = time;
      if (passages == 2 * kPeriods) return {(time - first) / kPeriods, amplitude};
      ++passages;
    }
    if (passages > 2 * kPeriods - 2) amplitude = std::max(amplitude, std::abs(now));
    before = now;
  }
  return {0, 0};
}

class SwingingBody : public ::testing::TestWithParam<Suspension> {};
INSTANTIATE_TEST_SUITE_P(From, SwingingBody,
                         ::testing::Values(Suspension::kPoint, Suspension::kHinge,
                                           Suspension::kLink),
                         [](const auto& suspension) {
                           return suspension.param == Suspension::kPoint   ? "Point"
                                  : suspension.param == Suspension::kHinge ? "Hinge"
                                                                           : "Link";
                         });

constexpr unsigned kSeeds[] = {1, 2};

// Relative error of the period at 1/60, 1/120 and 1/240 s.
std::vector<double> periodErrors(const Pendulum& pendulum, double correction) {
  std::vector<double> errors;
  for (const int rate : {60, 120, 240}) {
    const Swing swing = measure(pendulum, correction, 1.0 / rate);
    errors.push_back(swing.period / pendulum.period() - 1);
    EXPECT_NEAR(swing.amplitude / pendulum.amplitude, 1, 5e-3)
        << "amplitude " << pendulum.amplitude << ", 1/" << rate << " s";
  }
  return errors;
}

// Compares errors of successive steps; skipped in float32 because of rounding.
void expectSecondOrder(const std::vector<double>& errors, double tolerance) {
  if (sizeof(btScalar) != sizeof(double)) return;
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, tolerance);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, tolerance);
}

TEST_P(SwingingBody, HasThePeriodOfTheEllipticIntegral) {
  for (const unsigned seed : kSeeds) {
    for (const double amplitude : {0.1, 0.3}) {
      const Pendulum pendulum = Pendulum::random(GetParam(), seed, amplitude);
      const std::vector<double> errors = periodErrors(pendulum, kBulletsCorrection);
      EXPECT_LT(std::abs(errors[0]), 1e-4) << seed << ", amplitude " << amplitude;
      // Larger amplitudes: two errors of opposite sign nearly cancel.
      if (amplitude < 0.2) expectSecondOrder(errors, 0.1);
    }
  }
}

// A tangential step leaves the circle, and Bullet corrects a fifth of the error per step.
// So swings of 0.5 rad would lose 1 % in ten periods; 0.3 % in stock Bullet without
// fluid.
TEST_P(SwingingBody, HasThePeriodOfLargeSwingsWhereJointsAreCorrectedAtOnce) {
  for (const unsigned seed : kSeeds) {
    for (const double amplitude : {0.5, 1.0}) {
      const Pendulum pendulum = Pendulum::random(GetParam(), seed, amplitude);
      const std::vector<double> errors = periodErrors(pendulum, 1);
      EXPECT_LT(std::abs(errors[0]), amplitude < 1 ? 1e-4 : 2e-4) << seed << ", " << amplitude;
      if (amplitude == 1) expectSecondOrder(errors, 0.4);
    }
  }
}

}  // namespace
}  // namespace ambient::test
