#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/motion/kernel_fixture.h"
#include "tests/bullet_ambient/motion/loaded_bodies.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/matrices.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::FreeBody;

// A body of any mass that moves and turns; every third has a diagonal inertia.
FreeBody arbitraryBody(unsigned seed) {
  Arbitrary arbitrary(seed);
  Matrix6 added_mass = arbitrary.positiveDefinite();
  if (seed % 3 == 0) added_mass = Matrix6(added_mass.diagonal().asDiagonal());
  FreeBody body({test::shapeWithoutFaces(added_mass)});
  body.state.orientation = Quaternion(arbitrary.rotation());
  body.state.twist = arbitrary.twist(std::pow(10, arbitrary.between(-2, 2)), 3);
  body.setGravity({0, 0, -9.81});
  return body;
}

void setBody(RowLanes& lanes, int i, const FreeBody& body, double duration) {
  lanes.active[i] = 1;
  lanes.kick_time[i] = duration;
  setModel(lanes, i, body.model());
  setForces(lanes, i, {body.model(), body.surroundings, body.settings, duration});
  setLane(lanes.orientation, i, body.state.orientation);
  setLane(lanes.twist_B, i, body.state.twist);
}

class RowKernels : public test::FlightKernelTest {};

TEST_P(RowKernels, HaveTheBitsOfTheBaseline) {
  Arbitrary arbitrary(7);
  for (unsigned round = 0; round < 50; ++round) {
    const bool is_diagonal = round % 2 == 0;
    RowLanes rows{};
    rows.has_loads = true;
    rows.has_diagonal_inertia = is_diagonal;
    const double duration = std::pow(10, arbitrary.between(-4, -1));
    for (int i = 0; i < kFlightLanes; ++i) {
      const FreeBody body = arbitraryBody(3 * (round * kFlightLanes + static_cast<unsigned>(i)) +
                                          (is_diagonal ? 0 : 1));
      setBody(rows, i, body, duration);
      for (int k = 0; k < 6; ++k) rows.load_B[k][i] = 100 * arbitrary.between(-1, 1);
      setLane(rows.acceleration_W, i, arbitrary.vector());
      for (FlightLane* row : rows.isotropic_inverse_inertia) setLane(row, i, arbitrary.vector());
      rows.isotropic_inverse_mass[i] = arbitrary.between(0, 1);
      for (FlightLane* twist : {rows.velocity_W, rows.by_rows_W})
        setLane(twist, i, arbitrary.twist(10, 3));
      setLane(rows.displacement_W, i, arbitrary.vector());
    }
    RowLanes other_rows = rows;
    kernel_->predictRowVelocity(rows);
    kFlightKernelBaseline.predictRowVelocity(other_rows);
    EXPECT_EQ(std::memcmp(&rows, &other_rows, sizeof rows), 0);
    kernel_->conserve(rows);
    kFlightKernelBaseline.conserve(other_rows);
    EXPECT_EQ(std::memcmp(&rows, &other_rows, sizeof rows), 0);
    kernel_->transport(rows);
    kFlightKernelBaseline.transport(other_rows);
    EXPECT_EQ(std::memcmp(&rows, &other_rows, sizeof rows), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, RowKernels, test::kAllInstructionSets);

void expectSame(const RowVelocity& a, const RowVelocity& b) {
  EXPECT_EQ(a.change_W.vector(), b.change_W.vector());
  EXPECT_EQ(a.turning_W.vector(), b.turning_W.vector());
  EXPECT_EQ(a.isotropic_excess_W.vector(), b.isotropic_excess_W.vector());
  EXPECT_EQ(a.turn_number, b.turn_number);
  EXPECT_EQ(a.count.load_evaluations, b.count.load_evaluations);
}

TEST(RowsTogether, GiveABodyTheBitsThatItHasAlone) {
  constexpr double kStep = 0.01;
  std::vector<FreeBody> bodies;
  for (unsigned i = 0; i < kFlightsTogether; ++i) bodies.push_back(arbitraryBody(i));
  bodies[2] = test::tumblingEllipsoid({});
  bodies[5] = test::glidingDisc({});
  std::vector<FlightTask> tasks;
  const BodyModel* models[kFlightsTogether];
  for (const FreeBody& body : bodies) {
    models[tasks.size()] = &body.model();
    tasks.push_back({body.model(), body.surroundings, body.settings, kStep});
  }
  const auto number = [](int i) { return static_cast<std::size_t>(i); };
  for (const int count : {1, 3, kFlightsTogether}) {
    RowLanes lanes;
    RowLoad costs[kFlightsTogether];
    setModels(models, count, lanes);
    for (int i = 0; i < count; ++i)
      costs[i] = setStart(tasks[number(i)], bodies[number(i)].state, {}, i, lanes);
    kFlightKernels.fastest()->predictRowVelocity(lanes);
    for (int i = 0; i < count; ++i)
      expectSame(rowVelocityOf(lanes, i, costs[i]),
                 computeRowVelocity(tasks[number(i)], bodies[number(i)].state));
  }
}

// Velocities in W of a body with rows: xi, X and d of docs/theory.md eq. (31).
struct Velocities {
  Twist moving, turning, by_rows;
};

// Returns the lanes of one body after FlightKernel::conserve().
RowLanes kept(const FreeBody& body, const Quaternion& orientation, const Velocities& velocities,
              double step) {
  RowLanes lanes;
  const BodyModel* const model = &body.model();
  setModels(&model, 1, lanes);
  lanes.kick_time[0] = step;
  setLane(lanes.orientation, 0, orientation);
  setLane(lanes.velocity_W, 0, velocities.moving);
  setLane(lanes.turning_W, 0, velocities.turning);
  setLane(lanes.by_rows_W, 0, velocities.by_rows);
  kFlightKernels.fastest()->conserve(lanes);
  return lanes;
}

// A body that is carried nowhere keeps x = xi - X; one that is carried keeps P about the start.
TEST(KeptMotion, IsCarriedWithTheMomentum) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const FreeBody body = arbitraryBody(seed);
    Arbitrary arbitrary(100 + seed);
    const Quaternion start(arbitrary.rotation()), end(arbitrary.rotation());
    const Velocities velocities{arbitrary.twist(), arbitrary.twist(0.1, 0.1), arbitrary.twist()};
    RowLanes lanes = kept(body, start, velocities, 0.01);
    const auto carried = [&lanes](const Quaternion& orientation, const Vector3& way) {
      setLane(lanes.orientation, 0, orientation);
      setLane(lanes.displacement_W, 0, way);
      kFlightKernels.fastest()->transport(lanes);
      return twistOf(lanes.twist_B, 0);
    };
    const Twist still = turned(start, carried(start, Vector3::Zero()));
    const Vector6 x = velocities.moving.vector() - velocities.turning.vector();
    EXPECT_LT((still.vector() - x).norm(), 1e-12 * x.norm()) << seed;

    const Vector3 way = arbitrary.vector();
    const Twist moved = carried(end, way);
    const Momentum m = Momentum::fromVector(body.model().inertia * moved.vector());
    const Vector3 linear = end * m.linear, angular = end * m.angular + way.cross(linear);
    const Vector3 kept_angular = vectorOf(lanes.momentum_W, 0);
    const Vector3 kept_linear = vectorOf(lanes.momentum_W + 3, 0);
    EXPECT_LT((linear - kept_linear).norm(), 1e-12 * linear.norm()) << seed;
    EXPECT_LT((angular - kept_angular).norm(), 1e-11 * (1 + angular.norm())) << seed;
  }
}

// 2 E of eq. (31a) in the arithmetic of single bodies.
TEST(KeptMotion, HasTheEnergyOfItsEquation) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const FreeBody body = arbitraryBody(seed);
    Arbitrary arbitrary(200 + seed);
    const Quaternion q(arbitrary.rotation());
    const Twist velocity = arbitrary.twist(), share = arbitrary.twist(),
                by_rows = arbitrary.twist();
    const RowLanes lanes = kept(body, q, {velocity, share, by_rows}, 0.01);
    const Vector6 x = turned(q.conjugate(), velocity).vector();
    const Vector6 X = turned(q.conjugate(), share).vector();
    const Vector6 d = turned(q.conjugate(), by_rows).vector();
    const Matrix6& K = body.model().inertia;
    const double expected = (x - X).dot(K * (x - X)) + std::min(0.0, 2 * X.dot(K * d));
    EXPECT_NEAR(lanes.twice_energy[0], expected,
                1e-12 * (x.dot(K * x) + X.dot(K * X) + d.dot(K * d)));
  }
}

// m of eq. (28a) in the arithmetic of single bodies.
TEST(KeptMotion, HasTheExtentOfItsEquation) {
  constexpr double kStep = 0.01;
  bool is_by_spin = false, is_by_change = false;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const FreeBody body = arbitraryBody(seed);
    Arbitrary arbitrary(300 + seed);
    const Quaternion q(arbitrary.rotation());
    const Twist x = arbitrary.twist(3, seed % 2 == 0 ? 0.1 : 30);
    const double turn_number = kept(body, q, {turned(q, x), {}, {}}, kStep).moved_turn_number[0];
    const Matrix6& K = body.model().inertia;
    const Momentum m = Momentum::fromVector(K * x.vector());
    const Vector6 wrench =
        stack(m.angular.cross(x.angular) + m.linear.cross(x.linear), m.linear.cross(x.angular));
    Vector6 t = kStep * test::solve(K, wrench);
    t.tail<3>() += kStep * x.angular.cross(x.linear);
    const double by_spin = kStep * x.angular.norm() / 0.5;
    const double by_change = std::sqrt(t.dot(K * t) / x.vector().dot(K * x.vector())) / 0.45;
    EXPECT_NEAR(turn_number, std::max(by_spin, by_change), 1e-11 * turn_number) << seed;
    is_by_spin |= by_spin > by_change;
    is_by_change |= by_change > by_spin;
  }
  EXPECT_TRUE(is_by_spin && is_by_change);
}

class PoseKernels : public test::FlightKernelTest {
 protected:
  // Mean twist over a second from one orientation to another.
  Vector3 rotationVector(const Quaternion& from, const Quaternion& to) const {
    EndLanes lanes{};
    lanes.duration = 1;
    setLane(lanes.start_orientation, 3, from);
    setLane(lanes.orientation, 3, to);
    kernel_->findEnds(lanes);
    return vectorOf(lanes.mean_W, 3);
  }
};

TEST_P(PoseKernels, ReadEveryOrientationOfAMatrix) {
  Arbitrary arbitrary(1);
  for (int round = 0; round < 200; ++round) {
    StartLanes lanes{};
    Matrix3 rotations[kFlightLanes];
    Twist twists[kFlightLanes];
    for (int i = 0; i < kFlightLanes; ++i) {
      // Half turns and turns close to them; quarter turns, which have several equal entries.
      Vector3 axis = arbitrary.vector().normalized();
      if (round % 4 < 3) axis = Matrix3::Identity().col(round % 4);
      const double angle = i < 2 ? kPi : i < 4 ? kPi * (1 - 1e-9) : i * kPi / 6;
      rotations[i] =
          round % 2 == 0 ? Matrix3(rotationFromVector(angle * axis)) : arbitrary.rotation();
      twists[i] = arbitrary.twist(10, 10);
      for (int row = 0; row < 3; ++row)
        setLane(lanes.rotation + 3 * row, i, Vector3(rotations[i].row(row).transpose()));
      setLane(lanes.twist_W, i, twists[i]);
    }
    kernel_->readStarts(lanes);
    for (int i = 0; i < kFlightLanes; ++i) {
      const Quaternion q = orientationOf(lanes.orientation, i);
      EXPECT_NEAR(q.norm(), 1, 4e-16);
      EXPECT_LT((q.toRotationMatrix() - rotations[i]).cwiseAbs().maxCoeff(), 2e-15);
      const Twist back = twistOf(lanes.twist_B, i);
      EXPECT_LT((rotations[i] * back.angular - twists[i].angular).norm(), 1e-13);
      EXPECT_LT((rotations[i] * back.linear - twists[i].linear).norm(), 1e-13);
    }
  }
}

TEST_P(PoseKernels, FindTheRotationVectorOfEveryAngle) {
  Arbitrary arbitrary(2);
  for (const double angle : {0.0, 1e-300, 1e-20, 1e-8, 0.01, 0.1, 0.34, 0.35, 1.0, 3.1, kPi}) {
    const Vector3 r = angle * arbitrary.vector().normalized();
    const Vector3 back = rotationVector(Quaternion::Identity(), rotationFromVector(r));
    // At pi both signs of the axis give equal turns.
    const double error = std::min((back - r).norm(), angle > 3.14 ? (back + r).norm() : 1.0);
    EXPECT_LE(error, 6e-16 * angle) << angle;
    const Quaternion start(arbitrary.rotation());
    const Vector3 turned = rotationVector(start, rotationFromVector(r) * start);
    const double turned_error =
        std::min((turned - r).norm(), angle > 3.14 ? (turned + r).norm() : 1.0);
    EXPECT_LE(turned_error, 1e-15 * std::max(angle, 1.0)) << angle;
  }
}

TEST_P(PoseKernels, TakeTheShortWayForEitherSignOfTheQuaternion) {
  const Quaternion q(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()));
  const Quaternion same(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LT((rotationVector(Quaternion::Identity(), same) - Vector3(1, 0, 0)).norm(), 1e-15);
}

TEST_P(PoseKernels, GiveTheVelocitiesThatReachTheEnd) {
  Arbitrary arbitrary(3);
  EndLanes lanes{};
  lanes.duration = 0.02;
  const Quaternion start(arbitrary.rotation()), end(arbitrary.rotation());
  const Vector3 from = arbitrary.vector(), to = arbitrary.vector();
  const Twist twist = arbitrary.twist();
  setLane(lanes.start_orientation, 5, start);
  setLane(lanes.orientation, 5, end);
  setLane(lanes.start_position, 5, from);
  setLane(lanes.position, 5, to);
  setLane(lanes.twist_B, 5, twist);
  kernel_->findEnds(lanes);
  const Twist mean = twistOf(lanes.mean_W, 5), twist_W = twistOf(lanes.twist_W, 5);
  const Quaternion reached = rotationFromVector(0.02 * mean.angular) * start;
  EXPECT_LT(std::abs(std::abs(reached.dot(end)) - 1), 1e-15);
  EXPECT_LT((from + 0.02 * mean.linear - to).norm(), 1e-15);
  EXPECT_LT((twist_W.angular - end * twist.angular).norm(), 1e-14);
  EXPECT_LT((twist_W.linear - end * twist.linear).norm(), 1e-14);
}

TEST_P(PoseKernels, LeaveOutVelocitiesBelowTheLeast) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EndLanes lanes{};
  lanes.duration = 0.5;
  lanes.least = 1e-6;
  setLane(lanes.start_orientation, 2, Quaternion::Identity());
  setLane(lanes.orientation, 2, Quaternion::Identity());
  setLane(lanes.position, 2, Vector3(-0.49e-6, 0.51e-6, 0));
  const Twist twist{Vector3(-0.99e-6, -1.01e-6, kNaN), Vector3(1.01e-6, 0.99e-6, 1)};
  setLane(lanes.twist_B, 2, twist);
  kernel_->findEnds(lanes);
  const Twist mean = twistOf(lanes.mean_W, 2);
  EXPECT_EQ(mean.linear.x(), 0);
  EXPECT_EQ(mean.linear.y(), 0.51e-6 / lanes.duration);
  EXPECT_TRUE(std::isnan(lanes.twist_W[2][2]));
  lanes.twist_B[2][2] = 0;
  kernel_->findEnds(lanes);
  const Twist end = twistOf(lanes.twist_W, 2);
  EXPECT_EQ(end.angular, Vector3(0, -1.01e-6, 0));
  EXPECT_EQ(end.linear, Vector3(1.01e-6, 0, 1));
}

TEST_P(PoseKernels, HaveTheBitsOfTheBaseline) {
  Arbitrary arbitrary(4);
  for (int round = 0; round < 50; ++round) {
    StartLanes departure{};
    EndLanes arrival{};
    arrival.duration = arbitrary.between(1e-3, 1);
    for (int i = 0; i < kFlightLanes; ++i) {
      const Matrix3 rotation = arbitrary.rotation();
      for (int row = 0; row < 3; ++row)
        setLane(departure.rotation + 3 * row, i, Vector3(rotation.row(row).transpose()));
      setLane(departure.twist_W, i, arbitrary.twist());
      setLane(arrival.start_orientation, i, Quaternion(rotation));
      const Quaternion turn =
          rotationFromVector(arbitrary.vector(round % 2 == 0 ? 2 : 0.1)) * Quaternion(rotation);
      setLane(arrival.orientation, i, turn);
      setLane(arrival.start_position, i, arbitrary.vector());
      setLane(arrival.position, i, arbitrary.vector());
      setLane(arrival.twist_B, i, arbitrary.twist());
    }
    StartLanes other_departure = departure;
    EndLanes other_arrival = arrival;
    kernel_->readStarts(departure);
    kernel_->findEnds(arrival);
    kFlightKernelBaseline.readStarts(other_departure);
    kFlightKernelBaseline.findEnds(other_arrival);
    EXPECT_EQ(std::memcmp(departure.orientation, other_departure.orientation,
                          sizeof departure.orientation),
              0);
    EXPECT_EQ(std::memcmp(departure.twist_B, other_departure.twist_B, sizeof departure.twist_B), 0);
    EXPECT_EQ(std::memcmp(arrival.twist_W, other_arrival.twist_W, sizeof arrival.twist_W), 0);
    EXPECT_EQ(std::memcmp(arrival.mean_W, other_arrival.mean_W, sizeof arrival.mean_W), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PoseKernels, test::kAllInstructionSets);

}  // namespace
}  // namespace ambient
