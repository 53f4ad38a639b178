#include "bullet_ambient/motion/links/link_flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/motion/links/link_tree.h"
#include "demos/integrators/integrators.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/random_trees.h"

namespace ambient {
namespace {

constexpr JointKind kKinds[] = {JointKind::kFixed, JointKind::kRevolute, JointKind::kPrismatic,
                                JointKind::kSpherical, JointKind::kPlanar};

using Rotation = Eigen::AngleAxisd;
using Spin = Eigen::Quaterniond;

Eigen::Vector3d axis(const Joint& joint, int i) {
  const Vector6& S = joint.axes[i];
  return i == 0 && joint.kind != JointKind::kPrismatic ? S.head<3>() : S.tail<3>();
}

// Copy of Bullet 3.24's btMultiBody::stepPositionsMultiDof, for turns of less than pi/4.
JointPosition movedByBullet(const Joint& joint, JointPosition p, const double* u, double h) {
  switch (joint.kind) {
    case JointKind::kFixed:
      break;
    case JointKind::kRevolute:
    case JointKind::kPrismatic:
      p[0] += h * u[0];
      break;
    case JointKind::kSpherical: {
      const Spin q(p[3], p[0], p[1], p[2]);
      const Eigen::Vector3d w = q * Eigen::Vector3d(u[0], u[1], u[2]);
      const Spin turned = Spin(Rotation(h * w.norm(), w.normalized())) * q;
      p = {turned.x(), turned.y(), turned.z(), turned.w()};
      break;
    }
    case JointKind::kPlanar: {
      p[0] += h * u[0];
      const Eigen::Vector3d v =
          Rotation(p[0], axis(joint, 0)) * (u[1] * axis(joint, 1) + u[2] * axis(joint, 2));
      p[1] += h * axis(joint, 1).dot(v);
      p[2] += h * axis(joint, 2).dot(v);
    }
  }
  return p;
}

double distance(const JointPosition& a, const JointPosition& b) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += std::abs(a[i] - b[i]);
  return sum;
}

TEST(Joint, MovesAsInBulletButForPlanarOnes) {
  test::Arbitrary arbitrary(1);
  for (const JointKind kind : kKinds) {
    if (kind == JointKind::kPlanar) continue;
    for (const double speed : {1e-7, 1e-3, 1.0, 20.0}) {
      const Joint joint = test::randomJoint(arbitrary, kind);
      const JointPosition start = test::randomPosition(arbitrary, kind);
      const Vector3 u = arbitrary.vector(speed);
      const JointPosition expected = movedByBullet(joint, start, u.data(), 0.01);
      JointPosition end = moved(joint, start, u.data(), 0.01);
      for (int i = axisCount(kind); i < 4; ++i)
        if (axisCount(kind) < 3) end[i] = expected[i];  // unused
      EXPECT_LT(distance(end, expected), 1e-14) << speed;
    }
  }
}

TEST(Joint, BulletComesToTheEndByTheVelocityBetween) {
  test::Arbitrary arbitrary(2);
  for (const JointKind kind : kKinds) {
    for (const double speed : {1e-7, 1e-3, 1.0, 20.0}) {
      const Joint joint = test::randomJoint(arbitrary, kind);
      const JointPosition start = test::randomPosition(arbitrary, kind);
      const Vector3 u = arbitrary.vector(speed);
      const JointPosition end = moved(joint, start, u.data(), 0.01);
      Vector3 mean = Vector3::Zero();
      velocityBetween(joint, start, end, 0.01, mean.data());
      JointPosition reached = movedByBullet(joint, start, mean.data(), 0.01);
      for (int i = axisCount(kind); i < 4; ++i)
        if (axisCount(kind) < 3) reached[i] = end[i];
      EXPECT_LT(distance(reached, end), 1e-14) << speed;
    }
  }
}

// Rate of the pose must equal the axes S times the joint rates: V = E^T-rotated change of offset.
TEST(Joint, AxesAreTheRatesOfTheOffset) {
  test::Arbitrary arbitrary(3);
  for (const JointKind kind : kKinds) {
    const Joint joint = test::randomJoint(arbitrary, kind);
    const JointPosition start = test::randomPosition(arbitrary, kind);
    const Vector3 u = arbitrary.vector();
    Vector6 rate = Vector6::Zero();
    for (int i = 0; i < axisCount(kind); ++i) rate += u[i] * joint.axes[i];
    constexpr double kTime = 1e-5;
    const FrameOffset before = linkOffset(joint, moved(joint, start, u.data(), -kTime));
    const FrameOffset after = linkOffset(joint, moved(joint, start, u.data(), kTime));
    const Matrix3 R = linkOffset(joint, start).rotation;
    const Matrix3 turn = R.transpose() * (after.rotation - before.rotation) / (2 * kTime);
    const Vector3 way = R.transpose() * (after.translation - before.translation) / (2 * kTime);
    const Vector3 spin(turn(2, 1), turn(0, 2), turn(1, 0));
    EXPECT_LT((stack(spin, way) - rate).norm(), 1e-8);  // order 2 in kTime
  }
}

TEST(Joint, HalfAWayTwiceIsTheWay) {
  test::Arbitrary arbitrary(4);
  for (const JointKind kind : kKinds) {
    const Joint joint = test::randomJoint(arbitrary, kind);
    const JointPosition start = test::randomPosition(arbitrary, kind);
    const Vector3 u = arbitrary.vector(10);
    const JointPosition middle = moved(joint, start, u.data(), 0.05);
    const JointPosition end = moved(joint, start, u.data(), 0.1);
    EXPECT_LT(distance(moved(joint, middle, u.data(), 0.05), end), 1e-14);
    EXPECT_LT(distance(moved(joint, end, u.data(), -0.05), middle), 1e-14);
  }
}

using test::Arbitrary;
using test::randomTree;
using test::TestTree;
using test::TreeShape;

constexpr LinkFlightSettings kConverged{1e-12, 30, 16};
const double kPi = std::acos(-1.0);

struct TreeDrift {
  double energy = 0, momentum = 0;  // largest, relative
};

// Drift of a tree in an ideal fluid at rest, without forces.
TreeDrift driftOf(TestTree test, int hertz, double seconds, const LinkFlightSettings& settings) {
  LinkFlight flight(test.tree);
  LinkDynamics dynamics(test.tree);
  Coordinates momentum(test.u.size());
  const auto linearMomentum = [&]() -> Vector3 {
    dynamics.momentum(test.u, momentum);
    return momentum.segment<3>(3);
  };
  dynamics.setPose(test.pose);
  const double energy = dynamics.kineticEnergy(test.u);
  const Vector3 start = linearMomentum();
  TreeDrift drift;
  for (int i = 0; i < seconds * hertz; ++i) {
    EXPECT_TRUE(test.fly(flight, 1.0 / hertz, 1, settings).is_finite);
    dynamics.setPose(test.pose);
    drift.energy = std::max(drift.energy, std::abs(dynamics.kineticEnergy(test.u) / energy - 1));
    drift.momentum = std::max(drift.momentum, (linearMomentum() - start).norm() / start.norm());
  }
  return drift;
}

TestTree makeTree(unsigned seed, const TreeShape& shape) {
  Arbitrary arbitrary(seed);
  return randomTree(arbitrary, shape);
}

const TreeShape kChain{3, false, false, 5, 0.7};

TEST(LinkFlight, KeepsEnergyAndMomentum) {
  for (const unsigned seed : {11, 12, 13}) {
    const TreeDrift drift = driftOf(makeTree(seed, kChain), 60, 10, {});
    EXPECT_LT(drift.energy, 1e-12);
    EXPECT_LT(drift.momentum, 1e-12);
  }
  const TreeDrift drift = driftOf(makeTree(4, {5, true, true, 5, 0.3}), 60, 10, {});
  EXPECT_LT(drift.energy, 1e-12);
  EXPECT_LT(drift.momentum, 1e-12);
}

// Joints turn by half a radian in a step.
TEST(LinkFlight, KeepsTheEnergyOfFastLinks) {
  TreeShape shape = kChain;
  shape.speed = 5;
  for (const unsigned seed : {11, 12, 13})
    EXPECT_LT(driftOf(makeTree(seed, shape), 60, 10, {}).energy, 1e-10) << seed;
}

double distanceOf(const TestTree& a, const TestTree& b) {
  double distance = (a.pose.position - b.pose.position).norm() +
                    a.pose.orientation.angularDistance(b.pose.orientation);
  for (std::size_t l = 1; l < a.pose.joints.size(); ++l)
    for (int i = 0; i < 4; ++i)
      distance = std::max(distance, std::abs(a.pose.joints[l][i] - b.pose.joints[l][i]));
  return distance;
}

void expectSecondOrder(const TreeShape& shape, bool has_forces) {
  const auto flown = [&](int hertz) {
    TestTree test = makeTree(4, shape);
    Arbitrary arbitrary(1);
    if (has_forces) {
      const Vector3 flow = arbitrary.vector(), acceleration = arbitrary.vector();
      for (Link& link : test.tree.links) {
        link.surroundings.applied = {arbitrary.vector(0.01), arbitrary.vector(0.1)};
        link.surroundings.gravity = Vector3(0, 0, -9.81);
        link.surroundings.ambient_velocity = flow;
        link.surroundings.ambient_acceleration = acceleration;
        link.joint_force.fill(0.01);
      }
      test.tree.linear_damping = test.tree.angular_damping = 0.3;
      test.tree.has_gyroscopic_term = false;
    }
    LinkFlight flight(test.tree);
    test.fly(flight, 1.0 / hertz, hertz, kConverged);
    return test;
  };
  const TestTree exact = flown(4096);
  const double at_64 = distanceOf(flown(64), exact), at_128 = distanceOf(flown(128), exact);
  EXPECT_LT(at_64, 2e-2);
  EXPECT_NEAR(at_64 / at_128, 4, 0.5);
}

// Corrections for energy and momentum must not lower the order.
TEST(LinkFlight, IsOfSecondOrder) {
  expectSecondOrder({5, true, true, 5, 0.3}, false);
  expectSecondOrder({5, true, true, 5, 0.3}, true);
}

TEST(LinkFlight, FollowsFastLinksInSubsteps) {
  TreeShape shape = kChain;
  shape.speed = 7;
  TestTree test = makeTree(13, shape);
  LinkFlight flight(test.tree);
  flight.dynamics().setPose(test.pose);
  const double energy = flight.dynamics().kineticEnergy(test.u);
  const LinkFlightResult result = test.fly(flight, 1.0 / 60, 60);
  EXPECT_TRUE(result.is_finite);
  EXPECT_GT(result.count.substeps, 1);
  EXPECT_FALSE(result.count.coarse);
  flight.dynamics().setPose(test.pose);
  EXPECT_NEAR(flight.dynamics().kineticEnergy(test.u) / energy, 1, 0.02);
}

TEST(LinkFlight, SaysWhatItCouldNotFollow) {
  TreeShape shape = kChain;
  shape.speed = 1e4;
  TestTree test = makeTree(13, shape);
  LinkFlight flight(test.tree);
  EXPECT_TRUE(test.fly(flight, 1.0 / 60).count.coarse);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e200}) {
    test = makeTree(13, kChain);
    test.u[7] = bad;
    EXPECT_FALSE(test.fly(flight, 1.0 / 60).is_finite) << bad;
  }
}

// An ellipsoid on a hinge in water; the hinge is on its axis at the distance L. Period of the
// inertia J + K_ww + (m + K_vv) L^2 under (m - m_f) g L.
TEST(LinkFlight, SwingsWithTheAddedMassOfAnEllipsoid) {
  const Vector3 semi_axes(0.1, 0.15, 0.3);
  const double volume = 4.0 / 3 * kPi * semi_axes.prod(), density = 998, g = 9.81, L = 0.5;
  const double mass = 3 * density * volume;
  const Vector6 added = density * reference::ellipsoidAddedMass(semi_axes);
  Link base, bob;
  base.keeps_velocity = true;
  bob.parent = 0;
  bob.mass = mass;
  bob.inertia = mass / 5 *
                Vector3(semi_axes.tail<2>().squaredNorm(), 0.1 * 0.1 + 0.3 * 0.3,
                        semi_axes.head<2>().squaredNorm());
  bob.joint.kind = JointKind::kRevolute;
  bob.joint.pivot_to_link = Vector3(0, 0, -L);
  bob.joint.axes[0] = stack(Vector3::UnitX(), Vector3::UnitX().cross(bob.joint.pivot_to_link));
  TestTree test;
  test.tree.links = {base, bob};
  FluidBody shape = test::shapeWithoutFaces(Matrix6(added.asDiagonal()) / density, volume);
  test.setModel(1, test::modelOf({shape,
                                  {mass, bob.inertia.asDiagonal()},
                                  {density, 0, Vector3::Zero(), Vector3::Zero()}}));
  test.tree.links[1].surroundings.gravity = Vector3(0, 0, -g);
  test.tree.links[1].surroundings.applied.force = Vector3(0, 0, -mass * g);
  constexpr double kAngle = 0.01, kStep = 1e-3;
  test.pose.joints = {{}, {kAngle, 0, 0, 0}};
  test.u = Coordinates::Zero(7);
  const double inertia = bob.inertia.x() + added[0] + (mass + added[4]) * L * L;
  const double period = 2 * kPi * std::sqrt(inertia / ((mass - density * volume) * g * L)) *
                        (1 + kAngle * kAngle / 16);
  LinkFlight flight(test.tree);
  // A quarter of the period, by interpolation of the zero crossing.
  double time = 0, last = kAngle;
  while (test.pose.joints[1][0] > 0 && time < period) {
    last = test.pose.joints[1][0];
    test.fly(flight, kStep, 1, kConverged);
    time += kStep;
  }
  const double angle = test.pose.joints[1][0];
  const double quarter = time - kStep * angle / (angle - last);
  EXPECT_NEAR(4 * quarter, period, 2e-6 * period);  // order 2 in the step
}

TEST(LinkFlight, EndsWhereItsMeanVelocityLeads) {
  TestTree test = makeTree(5, {5, true, true, 5, 1});
  LinkFlight flight(test.tree);
  ASSERT_TRUE(flight.fly(test.pose, test.u, 1.0 / 60, {}).is_finite);
  // Joints other than planar ones move like Bullet's; joint_test.cpp covers planar ones.
  TreePose reached = test.pose;
  movePose(test.tree, test.pose, flight.meanVelocity(), 1.0 / 60, reached);
  const TreePose& end = flight.endPose();
  EXPECT_LT((reached.position - end.position).norm(), 1e-15);
  EXPECT_LT(reached.orientation.angularDistance(end.orientation), 1e-14);
  for (int l = 1; l < test.tree.size(); ++l) {
    if (test.tree.links[l].joint.kind == JointKind::kPlanar) continue;
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(reached.joints[l][i], end.joints[l][i], 1e-15);
  }
}

TEST(LinkFlight, LeavesLinksThatBulletDoesNotMove) {
  TestTree test = makeTree(5, {3, false, false, 5, 1});
  for (int l : {0, 1}) test.tree.links[l].keeps_velocity = test.tree.links[l].keeps_position = true;
  const TreePose start = test.pose;
  const Coordinates u = test.u;
  LinkFlight flight(test.tree);
  ASSERT_TRUE(test.fly(flight, 1.0 / 60).is_finite);
  EXPECT_EQ(test.pose.position, start.position);
  EXPECT_EQ(test.pose.joints[1], start.joints[1]);
  EXPECT_NE(test.pose.joints[2], start.joints[2]);
  EXPECT_EQ(test.u.head<7>(), u.head<7>());
  EXPECT_EQ(flight.meanVelocity().head<7>(), u.head<7>());
}

TEST(RowVelocityOfLinks, IsTheExplicitStep) {
  Arbitrary arbitrary(9);
  TestTree test = randomTree(arbitrary, {4, true, true});
  test::pushAround(arbitrary, test.tree);
  LinkFlight flight(test.tree);
  ASSERT_TRUE(flight.computeRowVelocity(test.pose, test.u, 0.01).is_finite);
  LinkDynamics dynamics(test.tree);
  dynamics.setPose(test.pose);
  dynamics.factor();
  Coordinates rate(test.u.size());
  dynamics.accelerations(test.u, rate);
  EXPECT_LT((flight.rowVelocity() + flight.turning() - test.u - 0.01 * rate).norm(),
            1e-13 * test.u.norm());
}

TEST(RowVelocityOfLinks, TurnsOnlyWhatMoves) {
  Arbitrary arbitrary(10);
  TestTree test = randomTree(arbitrary, {4, true, true});
  test::pushAround(arbitrary, test.tree);
  for (Link& link : test.tree.links) link.surroundings.ambient_velocity = Vector3(1, 2, 3);
  test.u.setZero();
  test.u.segment<3>(3) = Vector3(1, 2, 3);
  LinkFlight flight(test.tree);
  ASSERT_TRUE(flight.computeRowVelocity(test.pose, test.u, 0.01).is_finite);
  EXPECT_EQ(flight.turning().norm(), 0);
  test.u[7] = 3;
  ASSERT_TRUE(flight.computeRowVelocity(test.pose, test.u, 0.01).is_finite);
  EXPECT_GT(flight.turning().norm(), 0);
}

/// A law that is resistance alone.
class ResistanceAlone : public SurfaceLoads {
 public:
  Wrench load(const Twist&) const noexcept override { return {}; }
  SplitLoad split(const Twist&, const WetPart*) const noexcept override { return {{}, kCreeping}; }
};

// Gives links a resistance, stiff by 1e4 per second, against which each sinks at a velocity.
void giveResistances(TestTree& test, const Vector3& sinking) {
  Arbitrary arbitrary(2);
  for (int l = 0; l < test.tree.size(); ++l) {
    BodyModel model = *test.tree.links[l].model;
    const double drag = 1e4 * arbitrary.between(1, 3);
    Resistance resistance;
    resistance.matrix.diagonal() << Vector3::Constant(0.1 * drag), Vector3::Constant(drag);
    model.loads = std::make_shared<ResistanceAlone>();
    giveResistance(model, std::make_shared<Resistance>(resistance));
    test.setModel(l, std::move(model));
    test.tree.links[l].surroundings.applied.force = drag * sinking;
  }
}

TEST(RowVelocityOfLinks, KnowsItsPartByLoads) {
  TestTree test = makeTree(4, {4, true, true, 5, 0.3});
  giveResistances(test, {0.01, 0, -0.04});
  TestTree dry = makeTree(4, {4, true, true, 5, 0.3});
  for (int l = 0; l < dry.tree.size(); ++l)
    dry.tree.links[l].surroundings = test.tree.links[l].surroundings;
  LinkFlight flight(test.tree), without(dry.tree);
  ASSERT_TRUE(flight.computeRowVelocity(test.pose, test.u, 0.01).is_finite);
  ASSERT_TRUE(without.computeRowVelocity(dry.pose, dry.u, 0.01).is_finite);
  const Coordinates& by_loads = flight.rowVelocityByLoads();
  EXPECT_GT(by_loads.norm(), 0.1 * test.u.norm());
  EXPECT_LT((flight.rowVelocity() - without.rowVelocity() - by_loads).norm(),
            1e-12 * by_loads.norm());
}

// Links that each sink at V by themselves sink at V together, at any step.
TEST(LinkFlight, SinksSteadilyThroughAStiffFluid) {
  const Vector3 sinking(0.01, 0, -0.04);
  for (const int hertz : {30, 60, 1000}) {
    TestTree test = makeTree(4, {4, true, true, 5, 0.3});
    test.u.setZero();
    giveResistances(test, sinking);
    LinkFlight flight(test.tree);
    const Vector3 start = test.pose.position;
    ASSERT_TRUE(test.fly(flight, 1.0 / hertz, hertz).is_finite);
    EXPECT_LT((test.u.segment<3>(3) - sinking).norm(), 1e-5 * sinking.norm()) << hertz;
    EXPECT_LT((test.pose.position - start - sinking).norm(), 0.03 * sinking.norm()) << hertz;
  }
}

}  // namespace
}  // namespace ambient
