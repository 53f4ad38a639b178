#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"
#include "tests/bullet_ambient/bullet/contact/uneven_body.h"

namespace ambient::test {
namespace {

// Moving, anchored, soft, rolling and spinning friction, against the dense solution.

template <class Kind>
class FrictionTerms : public ::testing::Test {};
using FrictionSolvers = ::testing::Types<SequentialImpulse, ConjugateGradientForJoints, Dantzig,
                                         ProjectedGaussSeidel, Lemke, Multithreaded, MultiBody>;
TYPED_TEST_SUITE(FrictionTerms, FrictionSolvers, SolverName);

// A belt's surface velocity, an anchor with position error, and soft friction. Bullet's
// softness of friction is a multiple of the row's response. Complementarity solvers ignore this
// softness.
TYPED_TEST(FrictionTerms, MovingAndAnchoredEqualTheDenseSolution) {
  expectErrors(45, 300, 200, kTolerance, [](Arbitrary& arbitrary, int i) -> CaseError {
    ContactPair pair = arbitraryPair(arbitrary, kOthers[i % 3]);
    btContactSolverInfo info = convergingSettings(gyroscopicTime(pair, 0.05));
    pushAtRandom(arbitrary, pair, info.m_timeStep);
    info.m_frictionERP = btScalar(arbitrary.between(0, 0.5));
    btManifoldPoint& point = pair.point();
    point.m_contactMotion1 = btScalar(arbitrary.between(-1, 1));
    point.m_contactMotion2 = btScalar(arbitrary.between(-1, 1));
    point.m_combinedFriction = btScalar(arbitrary.between(0.05, 0.6));
    if (!kIsComplementarity<TypeParam>) point.m_frictionCFM = btScalar(arbitrary.between(0, 0.5));
    if (i / 3 % 2 == 1) {
      point.m_contactPointFlags |= BT_CONTACT_FLAG_FRICTION_ANCHOR;
      point.m_positionWorldOnB += toBt(arbitrary.vector(0.05 * pair.a().size()));
    }
    const Vector3r apart = exact(point.m_positionWorldOnA) - exact(point.m_positionWorldOnB);
    const Before before(pair);
    const auto bodies = pair.dense(info.m_timeStep);
    Rows rows = pair.frictionRows(0, kFrictionBound<TypeParam>, info.m_timeStep);
    for (int t : {0, 1}) {
      reference::DenseRow& row = rows[1 + t];
      row.target = t == 0 ? point.m_contactMotion1 : point.m_contactMotion2;
      if (point.m_contactPointFlags & BT_CONTACT_FLAG_FRICTION_ANCHOR)
        row.target -= apart.dot(pair.tangent(t)) * info.m_frictionERP / info.m_timeStep;
      row.softness = point.m_frictionCFM * reference::response(bodies, row, row);
    }
    const auto expected = reference::onlySolution(bodies, rows);
    if (!expected || !(expected->impulses[0] > 1e-9L)) return std::nullopt;
    if (!pair.template solve<TypeParam>(info)) return std::nullopt;
    return worstError(pair, *expected, before);
  });
}

template <class Kind>
class TorsionalFriction : public ::testing::Test {};
using TorsionalSolvers =
    ::testing::Types<SequentialImpulse, ConjugateGradientForJoints, Multithreaded, MultiBody>;
TYPED_TEST_SUITE(TorsionalFriction, TorsionalSolvers, SolverName);

// Adds rolling and spinning rows. Bullet's bound is min(coefficient, coefficient times normal
// impulse). Complementarity solvers have no such rows.
Rows withTorsionalRows(ContactPair& pair, Rows rows) {
  const btManifoldPoint& point = pair.point();
  btVector3 axis[2];
  btPlaneSpace1(point.m_normalWorldOnB, axis[0], axis[1]);
  const auto add = [&](const btVector3& direction, btScalar friction) {
    rows.push_back(reference::spinRow(exact(direction)));
    rows.back().normal_row = 0;
    rows.back().friction = friction;
  };
  add(point.m_normalWorldOnB, point.m_combinedSpinningFriction);
  for (btVector3& direction : axis) add(direction.normalized(), point.m_combinedRollingFriction);
  return rows;
}

// Returns the solution if exactly one of the two bounds gives a valid one.
std::optional<reference::DenseSolution> torsionalSolution(
    const std::vector<reference::DenseBody>& bodies, const Rows& rows, int first_torsional) {
  Rows at_most = rows;
  for (std::size_t r = first_torsional; r < rows.size(); ++r) {
    at_most[r].normal_row = -1;
    at_most[r].lower = -rows[r].friction;
    at_most[r].upper = rows[r].friction;
  }
  const auto below = reference::onlySolution(bodies, rows);
  const auto above = reference::onlySolution(bodies, at_most);
  if (!below || !above) return std::nullopt;
  const bool is_below = below->impulses[0]<1, is_above = above->impulses[0]> 1;
  if (is_below == is_above) return std::nullopt;
  return is_below ? below : above;
}

TYPED_TEST(TorsionalFriction, RollingAndSpinningEqualTheDenseSolution) {
  Arbitrary arbitrary(46);
  double worst = 0;
  int sticking = 0, sliding = 0, capped = 0;
  for (int i = 0; i < 220; ++i) {
    ContactPair pair = arbitraryPair(arbitrary, kOthers[i % 3]);
    const btContactSolverInfo info = convergingSettings(gyroscopicTime(pair, 0.05));
    pushAtRandom(arbitrary, pair, info.m_timeStep);
    btManifoldPoint& point = pair.point();
    point.m_combinedSpinningFriction = btScalar(arbitrary.between(0, 0.5) * pair.a().size());
    point.m_combinedRollingFriction = btScalar(arbitrary.between(0.01, 0.5) * pair.a().size());
    // Lateral friction for some pairs only: the reference tries all combinations of bounds.
    const bool with_lateral = i % 20 < 3;
    if (with_lateral) point.m_combinedFriction = btScalar(arbitrary.between(0.05, 0.4));
    const Before before(pair);
    const auto bodies = pair.dense(info.m_timeStep);
    Rows rows = pair.frictionRows(0, FrictionBound::kNormalImpulse, info.m_timeStep);
    if (!with_lateral) rows.resize(1);
    const auto first = static_cast<int>(rows.size());
    rows = withTorsionalRows(pair, rows);
    const auto expected = torsionalSolution(bodies, rows, first);
    if (!expected || !(expected->impulses[0] > 1e-9L)) continue;
    if (!pair.template solve<TypeParam>(info)) continue;
    capped += expected->impulses[0] > 1;
    for (std::size_t r = first; r < rows.size(); ++r) {
      const Real bound = rows[r].friction * std::min<Real>(1, expected->impulses[0]);
      ++(std::abs(expected->impulses[r]) < bound * (1 - 1e-12L) ? sticking : sliding);
    }
    worst = std::max(worst, worstError(pair, *expected, before));
  }
  EXPECT_GE(sticking, 50);
  EXPECT_GT(sliding, 50);
  EXPECT_GT(capped, 15);
  EXPECT_LT(worst, kTolerance);
}

// Bodies at rest on a slope, kept awake, in Bullet's default mode of one friction row per contact.
// An uneven body slips in another direction than the push.

constexpr double kSlope = 0.25, kSlopeFriction = 0.8, kSlopeStep = 1.0 / 60;
// Settling time: bodies little denser than water roll for seconds.
constexpr int kSettling = 600, kSliding = 540;

// A slope by oblique gravity on a level floor.
struct Slope : FluidWorld {
  explicit Slope(double angle = kSlope) {
    world.setGravity({bt(9.81 * std::sin(angle)), 0, bt(-9.81 * std::cos(angle))});
    floor.setFriction(1);
    world.addRigidBody(&floor);
  }
  ~Slope() { world.removeRigidBody(&floor); }

  void place(btRigidBody& body) {
    body.setGravity(world.getGravity());
    body.setFriction(bt(kSlopeFriction));
  }
  /// Distance moved after settling [m].
  double creep(const btRigidBody& body) {
    step(kSlopeStep, kSettling);
    const Vector3 start = readState(body).position;
    step(kSlopeStep, kSliding);
    return (readState(body).position - start).norm();
  }

  btCompoundShape tilted;  // shape of one body
  btConvexHullShape hull;
  btStaticPlaneShape plane{{0, 0, 1}, 0};
  btRigidBody floor{0, nullptr, &plane};
};

struct Worst {
  double ambient = 0, stock = 0;
};

// Largest creep of `count` bodies with fluid and without; `add` puts one into a world.
template <class Add>
Worst worstCreep(int count, const Add& add, int stock_mode = 0) {
  Worst worst;
  for (int seed = 0; seed < count; ++seed) {
    for (const bool in_fluid : {false, true}) {
      Slope slope;
      Arbitrary arbitrary(seed);
      if (!in_fluid) slope.world.getSolverInfo().m_solverMode |= stock_mode;
      btRigidBody& body = add(slope, arbitrary, in_fluid);
      slope.place(body);
      double& creep = in_fluid ? worst.ambient : worst.stock;
      creep = std::max(creep, slope.creep(body));
      slope.world.removeRigidBody(&body);
    }
  }
  return worst;
}

TEST(Slope, HoldsBoxesOfCoupledInertiaAsWellAsDryOnes) {
  btBoxShape box({bt(0.5), bt(0.4), bt(0.3)});
  const Worst worst =
      worstCreep(20, [&](Slope& slope, Arbitrary& arbitrary, bool in_fluid) -> btRigidBody& {
        BodyDef def{1, Vector3(0.25, 0.34, 0.41) / 3, {}, &box};
        def.start.position = {0, 0, 0.3};
        def.start.orientation = Eigen::AngleAxisd(arbitrary.between(0, 3), Vector3::UnitZ());
        return in_fluid ? slope.add(def, unevenFluid(arbitrary, 2), idealFluid(1)) : slope.add(def);
      });
  EXPECT_LT(worst.ambient, worst.stock);
}

// K is diagonal, oblique to the normal of the lower face. Stock Bullet has two friction rows here:
// dry boxes of equal moments creep by 0.3 mm, with one row by 0.01 mm.
TEST(Slope, HoldsBodiesThatStandOnATiltedFace) {
  btBoxShape box({bt(0.5), bt(0.4), bt(0.3)});
  const Worst worst = worstCreep(
      20,
      [&](Slope& slope, Arbitrary& arbitrary, bool in_fluid) -> btRigidBody& {
        BodyDef def{1, Vector3::Constant(0.12), {}, nullptr};
        const Quaternion tilt(
            Eigen::AngleAxisd(arbitrary.between(0.3, 1), arbitrary.vector().normalized()));
        slope.tilted.addChildShape(btTransform(toBullet(tilt)), &box);
        def.shape = &slope.tilted;
        def.start.position = {0, 0, 0.3};
        def.start.orientation = tilt.conjugate();
        Vector6 diagonal;
        diagonal << 0.1, 0.2, 0.1, 0.2, 0.5, 2;
        return in_fluid ? slope.add(def, inertiaAlone(diagonal.asDiagonal()), idealFluid(1))
                        : slope.add(def);
      },
      SOLVER_USE_2_FRICTION_DIRECTIONS);
  EXPECT_LT(worst.ambient, worst.stock);
}

// Adds an irregular body to the slope; its points are random.
btRigidBody& addHull(Slope& slope, Arbitrary& arbitrary, double density_ratio, bool in_fluid) {
  const Vector3 axes(0.3, 0.25, 0.15);
  for (int i = 0; i < 20; ++i)
    slope.hull.addPoint(toBullet(Vector3(arbitrary.vector().normalized().cwiseProduct(axes))));
  const double mass = density_ratio * water().density * ellipsoidVolume(axes);
  btRigidBody& body =
      slope.add({mass, ellipsoidMoments(axes, mass), startAt({0, 0, 0.2}), &slope.hull});
  if (!in_fluid) return body;
  AttachDef attach{std::make_shared<FluidBody>(meshedEllipsoid(axes, 1)), water()};
  attach.fluid_frame.rotation =
      Quaternion(Eigen::AngleAxisd(0.3, arbitrary.vector().normalized())).toRotationMatrix();
  attach.fluid_frame.translation = arbitrary.vector(0.01);
  slope.fluid.add(body, attach);
  return body;
}

TEST(Slope, HoldsRandomHullsAsWellAsDryOnes) {
  for (const double density_ratio : {1.2, 2.7}) {
    const auto add = [&](Slope& slope, Arbitrary& arbitrary, bool in_fluid) -> btRigidBody& {
      return addHull(slope, arbitrary, density_ratio, in_fluid);
    };
    const Worst worst = worstCreep(6, add);
    EXPECT_LT(worst.ambient, worst.stock) << density_ratio;
  }
}

int contactsOf(btDispatcher& dispatcher) {
  int count = 0;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i)
    count += dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
  return count;
}

// Rows per contact in the first step of a box on the slope.
double rowsPerContact(double angle, const FluidBody& shape) {
  Slope slope(angle);
  btBoxShape box({bt(0.5), bt(0.4), bt(0.3)});
  btRigidBody& body = slope.add({1, Vector3(0.25, 0.34, 0.41) / 3, startAt({0, 0, 0.3}), &box},
                                shape, idealFluid(1));
  slope.place(body);
  slope.step(kSlopeStep);
  const double rows = static_cast<double>(slope.of(body).counters().rows);
  const int contacts = contactsOf(*slope.world.getDispatcher());
  EXPECT_GT(contacts, 0);
  slope.world.removeRigidBody(&body);
  return rows / contacts;
}

TEST(Slope, CostsASecondRowOnlyWhereFrictionHoldsItAndThePushTurnsAside) {
  Arbitrary arbitrary(1);
  const FluidBody coupled = unevenFluid(arbitrary, 2);
  EXPECT_EQ(rowsPerContact(0, coupled), 2);
  EXPECT_EQ(rowsPerContact(0.005, coupled), 2);
  EXPECT_EQ(rowsPerContact(0.05, coupled), 3);
  EXPECT_EQ(rowsPerContact(0.95 * std::atan(kSlopeFriction), coupled), 3);
  EXPECT_EQ(rowsPerContact(1.05 * std::atan(kSlopeFriction), coupled), 2);
  Vector6 even;
  even << 0.1, 0.2, 0.1, 0.2, 0.5, 2;
  EXPECT_EQ(rowsPerContact(0.05, inertiaAlone(even.asDiagonal())), 2);
}

// A block on level ground, kept awake, `askew` to a current along x [rad]; in a vacuum it has what
// buoyancy leaves of its weight.
struct Block : FluidWorld {
  Block(double askew, double current, bool in_fluid) {
    const double volume = ellipsoidVolume(kSemiAxes), mass = 1500 * volume;
    world.setGravity({0, 0, bt(in_fluid ? -9.81 : -9.81 * (1 - 998.2 / 1500))});
    world.addRigidBody(&floor);
    BodyDef def{
        mass, ellipsoidMoments(kSemiAxes, mass),
        startAt({0, 0, kSemiAxes.z()}, {}, Quaternion(Eigen::AngleAxisd(askew, Vector3::UnitZ()))),
        &shape};
    Medium stream = water();
    stream.velocity = {current, 0, 0};
    body = in_fluid ? &add(def, meshedEllipsoid(kSemiAxes, 2), stream) : &add(def);
  }
  ~Block() { world.removeRigidBody(&floor); }

  /// Distance that it creeps in 20 s after 5 s [m].
  double creep(double hertz) {
    step(1 / hertz, static_cast<int>(5 * hertz));
    const Vector3 start = readState(*body).position;
    step(1 / hertz, static_cast<int>(20 * hertz));
    return (readState(*body).position - start).norm();
  }

  inline static const Vector3 kSemiAxes{0.3, 0.1, 0.15};
  btBoxShape shape{toBullet(kSemiAxes)};
  btStaticPlaneShape plane{{0, 0, 1}, 0};
  btRigidBody floor{0, nullptr, &plane};
  btRigidBody* body = nullptr;
};

// Munk's moment turns it in each step, and friction holds it.
TEST(Current, LetsBlocksCreepNoFartherThanStockBulletInAVacuum) {
  for (const double hertz : {30.0, 60.0}) {
    Worst worst;
    for (const double askew : {0.1, 0.25, 0.4, 0.55, 0.8, 1.1, 1.4}) {
      worst.stock = std::max(worst.stock, Block(askew, 0, false).creep(hertz));
      for (const double current : {0.2, 0.4})
        worst.ambient = std::max(worst.ambient, Block(askew, current, true).creep(hertz));
    }
    EXPECT_LT(worst.ambient, worst.stock) << hertz << " Hz";
  }
}

}  // namespace
}  // namespace ambient::test
