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
#include "tests/bullet_ambient/bullet/contact/uneven_body.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

// Pendulums with coupled K in a stock world. The joint allows one twist s = (z, z x r), constant in
// body axes. So the body is a plane pendulum of inertia s.K s for every K.

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
    return startAt(turn * Vector3(0, -kLength, 0), {}, turn * hanging);
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
    fluid_.add(*body_, {std::make_shared<FluidBody>(shapeWithoutFaces(pendulum.added_mass, 0)),
                        {1, 0, Vector3::Zero(), Vector3::Zero()}});
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

// Joined bodies in an ideal fluid without further forces, added mass up to twice their mass. Body
// and fluid keep linear momentum and, in the limit of short steps, energy.

enum class Link { kFixed, kBall, kHinge };

std::unique_ptr<btTypedConstraint> makeLink(Link link, btRigidBody& a, btRigidBody& b) {
  const btVector3 right(bt(0.5), 0, 0), axis(0, 0, 1);
  if (link == Link::kBall) return std::make_unique<btPoint2PointConstraint>(a, b, right, -right);
  if (link == Link::kHinge)
    return std::make_unique<btHingeConstraint>(a, b, right, -right, axis, axis);
  const btTransform in_a(btQuaternion::getIdentity(), right);
  return std::make_unique<btFixedConstraint>(a, b, in_a, in_a.inverse());
}

// A row of joined bodies in a common rotation at 1 rad/s.
class Row {
 public:
  Row(Link link, int count, unsigned seed) {
    Arbitrary arbitrary(seed);
    const Vector3 spin = arbitrary.vector().normalized();
    for (int i = 0; i < count; ++i) {
      BodyDef def = unevenBody();
      def.start.position = {double(i), 0, 0};
      def.start.twist = {spin, spin.cross(def.start.position)};
      const FluidBody shape = unevenFluid(arbitrary, 2);
      bodies_.push_back(&scene_.add(def, shape, idealFluid(1)));
    }
    for (int i = 1; i < count; ++i)
      scene_.contents.join(makeLink(link, *bodies_[i - 1], *bodies_[i]));
  }
  void step(double duration) { scene_.step(duration); }
  double energy() const {
    double sum = 0;
    for (const btRigidBody* body : bodies_) sum += kineticEnergy(scene_, *body);
    return sum;
  }
  Vector3 momentum() const {
    Vector3 sum = Vector3::Zero();
    for (const btRigidBody* body : bodies_) sum += worldMomentum(scene_, *body).linear;
    return sum;
  }

 private:
  FluidWorld scene_;
  std::vector<btRigidBody*> bodies_;
};

struct Drift {
  double momentum = 0, energy = 0;  ///< largest changes relative to the start
};

Drift driftOf(Link link, int count, double step) {
  Drift drift;
  for (unsigned seed = 100; seed < 104; ++seed) {
    Row row(link, count, seed);
    const double energy = row.energy();
    const Vector3 momentum = row.momentum();
    for (int i = 0; i < std::lround(10 / step); ++i) {
      row.step(step);
      drift.momentum =
          std::max(drift.momentum, (row.momentum() - momentum).norm() / momentum.norm());
      drift.energy = std::max(drift.energy, std::abs(row.energy() / energy - 1));
    }
  }
  return drift;
}

class JoinedPair : public ::testing::TestWithParam<Link> {};
INSTANTIATE_TEST_SUITE_P(Links, JoinedPair,
                         ::testing::Values(Link::kFixed, Link::kBall, Link::kHinge));

TEST_P(JoinedPair, KeepsItsMomentum) {
  for (const double rate : {30, 60, 240})
    EXPECT_LT(driftOf(GetParam(), 2, 1 / rate).momentum, byPrecision(1e-12, 1e-5)) << rate;
}

TEST_P(JoinedPair, KeepsItsEnergyToSecondOrder) {
  const double coarse = driftOf(GetParam(), 2, 1.0 / 60).energy;
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(driftOf(GetParam(), 2, 1.0 / 120).energy, byPrecision(0.3, 0.5) * coarse);
}

/// Energies of a body on a ball joint at its rim in two seconds, over its energy at the start.
struct TopEnergy {
  double largest = 1, end = 1;
};

TopEnergy energyOfTop(double spin, double rate, unsigned seed) {
  Arbitrary arbitrary(seed);
  const Vector3 axis = arbitrary.vector().normalized(), pivot(0.5, 0, 0);
  FluidWorld scene;
  BodyDef def = unevenBody();
  def.start.twist = {spin * axis, spin * pivot.cross(axis)};
  btRigidBody& body = scene.add(def, unevenFluid(arbitrary, 3), idealFluid(1));
  scene.contents.take(std::make_unique<btPoint2PointConstraint>(body, toBullet(pivot)));
  const double start = kineticEnergy(scene, body);
  TopEnergy top;
  for (int i = 0; i < 2 * rate; ++i) {
    scene.step(1 / rate);
    top.end = kineticEnergy(scene, body) / start;
    top.largest = std::max(top.largest, top.end);
  }
  return top;
}

// Up to a third of a turn per step and far beyond. Stock Bullet gains 53 times at 1000 rad/s.
TEST(Top, OnABallJointGainsNoEnergy) {
  for (const double spin : {1, 10, 40, 200, 1000})
    for (unsigned seed = 0; seed < 15; ++seed) {
      const double rate = 30 << seed % 5;
      EXPECT_LT(energyOfTop(spin, rate, seed).largest, 1.02) << spin << " rad/s, " << rate << " Hz";
    }
}

// Energy removed by the bounds (31a) and (31b) grows with the turn per step; docs/stability.md has
// mean values.
TEST(Top, OnABallJointLosesNoMoreThanItsTurnPerStepExplains) {
  struct Case {
    double spin, rate, least;
  };
  constexpr unsigned kTops = 24;
  for (const auto& [spin, rate, least] :
       {Case{1, 60, 0.999}, Case{10, 240, 0.98}, Case{10, 60, 0.8}, Case{20, 60, 0.33},
        Case{60, 60, 0.2}}) {
    double mean = 0;
    for (unsigned seed = 0; seed < kTops; ++seed) mean += energyOfTop(spin, rate, seed).end / kTops;
    EXPECT_GT(mean, least) << spin << " rad/s, " << rate << " Hz";
  }
}

}  // namespace
}  // namespace ambient::test
