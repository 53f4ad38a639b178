#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

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

void setBody(FlightLanes& lanes, int i, const FreeBody& body, double duration) {
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
    PushLanes push{};
    RowMotionLanes rows{};
    push.bodies.has_loads = true;
    push.bodies.has_diagonal_inertia = rows.bodies.has_diagonal_inertia = is_diagonal;
    const double duration = std::pow(10, arbitrary.between(-4, -1));
    for (int i = 0; i < kFlightLanes; ++i) {
      const FreeBody body = arbitraryBody(3 * (round * kFlightLanes + static_cast<unsigned>(i)) +
                                          (is_diagonal ? 0 : 1));
      setBody(push.bodies, i, body, duration);
      setBody(rows.bodies, i, body, duration);
      for (int k = 0; k < 6; ++k) push.bodies.load_B[k][i] = 100 * arbitrary.between(-1, 1);
      setLane(push.acceleration_W, i, arbitrary.vector());
      for (FlightLane* row : push.even_inverse_inertia) setLane(row, i, arbitrary.vector());
      push.even_inverse_mass[i] = arbitrary.between(0, 1);
      for (FlightLane* twist : {rows.velocity_W, rows.turning_W, rows.by_rows_W})
        setLane(twist, i, arbitrary.twist(10, 3));
      setLane(rows.bodies.way_W, i, arbitrary.vector());
    }
    PushLanes other_push = push;
    RowMotionLanes other_rows = rows;
    kernel_->push(push);
    kFlightKernelBaseline.push(other_push);
    EXPECT_EQ(std::memcmp(&push, &other_push, sizeof push), 0);
    kernel_->keep(rows);
    kFlightKernelBaseline.keep(other_rows);
    EXPECT_EQ(std::memcmp(&rows, &other_rows, sizeof rows), 0);
    kernel_->carry(rows);
    kFlightKernelBaseline.carry(other_rows);
    EXPECT_EQ(std::memcmp(&rows, &other_rows, sizeof rows), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, RowKernels, test::kAllInstructionSets);

void expectSame(const RowVelocity& a, const RowVelocity& b) {
  EXPECT_EQ(a.change_W.vector(), b.change_W.vector());
  EXPECT_EQ(a.turning_W.vector(), b.turning_W.vector());
  EXPECT_EQ(a.isotropic_excess_W.vector(), b.isotropic_excess_W.vector());
  EXPECT_EQ(a.extent, b.extent);
  EXPECT_EQ(a.count.load_evaluations, b.count.load_evaluations);
}

TEST(RowsTogether, GiveABodyTheBitsThatItHasAlone) {
  constexpr double kStep = 0.01;
  std::vector<FreeBody> bodies;
  for (unsigned i = 0; i < kFlightsTogether; ++i) bodies.push_back(arbitraryBody(i));
  bodies[2] = test::tumblingEllipsoid({});
  bodies[5] = test::glidingDisc({});
  std::vector<RowTask> tasks;
  const RowTask* all[kFlightsTogether];
  for (const FreeBody& body : bodies)
    tasks.push_back({{body.model(), body.surroundings, body.settings, kStep}, body.state});
  for (int i = 0; i < kFlightsTogether; ++i) all[i] = &tasks[static_cast<std::size_t>(i)];
  for (const int count : {1, 3, kFlightsTogether}) {
    RowVelocity together[kFlightsTogether];
    computeRowVelocities(all, count, together);
    for (int i = 0; i < count; ++i)
      expectSame(together[i], computeRowVelocity(all[i]->task, all[i]->start));
  }
}

// A body that is carried nowhere keeps x = xi - X; one that is carried keeps P about the start.
TEST(KeptMotion, IsCarriedWithTheMomentum) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const FreeBody body = arbitraryBody(seed);
    Arbitrary arbitrary(100 + seed);
    const Quaternion start(arbitrary.rotation()), end(arbitrary.rotation());
    const BodyWithRows with_rows{body.model(), start, arbitrary.twist(), arbitrary.twist(0.1, 0.1),
                                 arbitrary.twist()};
    const BodyWithRows* const one = &with_rows;
    KeptMotion kept;
    computeKeptMotions(&one, 1, 0.01, &kept);
    const auto carried = [&](const Quaternion& orientation, const Vector3& way) {
      const CarriedBody moved{body.model(), orientation, kept.momentum_W, way};
      const CarriedBody* const moved_one = &moved;
      Twist twist_B;
      computeCarriedTwists(&moved_one, 1, &twist_B);
      return twist_B;
    };
    const Twist still = turned(start, carried(start, Vector3::Zero()));
    const Vector6 x = with_rows.velocity_W.vector() - with_rows.turning_W.vector();
    EXPECT_LT((still.vector() - x).norm(), 1e-12 * x.norm()) << seed;

    const Vector3 way = arbitrary.vector();
    const Twist moved = carried(end, way);
    const Momentum m = Momentum::fromVector(body.model().inertia * moved.vector());
    const Vector3 linear = end * m.linear, angular = end * m.angular + way.cross(linear);
    EXPECT_LT((linear - kept.momentum_W.linear).norm(), 1e-12 * linear.norm()) << seed;
    EXPECT_LT((angular - kept.momentum_W.angular).norm(), 1e-11 * (1 + angular.norm())) << seed;
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
    const BodyWithRows with_rows{body.model(), q, velocity, share, by_rows};
    const BodyWithRows* const one = &with_rows;
    KeptMotion kept;
    computeKeptMotions(&one, 1, 0.01, &kept);
    const Vector6 x = turned(q.conjugate(), velocity).vector();
    const Vector6 X = turned(q.conjugate(), share).vector();
    const Vector6 d = turned(q.conjugate(), by_rows).vector();
    const Matrix6& K = body.model().inertia;
    const double expected = (x - X).dot(K * (x - X)) + std::min(0.0, 2 * X.dot(K * d));
    EXPECT_NEAR(kept.twice_energy, expected, 1e-12 * (x.dot(K * x) + X.dot(K * X) + d.dot(K * d)));
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
    const BodyWithRows with_rows{body.model(), q, turned(q, x), {}, {}};
    const BodyWithRows* const one = &with_rows;
    KeptMotion kept;
    computeKeptMotions(&one, 1, kStep, &kept);
    const Matrix6& K = body.model().inertia;
    const Momentum m = Momentum::fromVector(K * x.vector());
    const Vector6 wrench =
        stack(m.angular.cross(x.angular) + m.linear.cross(x.linear), m.linear.cross(x.angular));
    Vector6 t = kStep * test::solve(K, wrench);
    t.tail<3>() += kStep * x.angular.cross(x.linear);
    const double by_spin = kStep * x.angular.norm() / 0.5;
    const double by_change = std::sqrt(t.dot(K * t) / x.vector().dot(K * x.vector())) / 0.45;
    EXPECT_NEAR(kept.extent, std::max(by_spin, by_change), 1e-11 * kept.extent) << seed;
    is_by_spin |= by_spin > by_change;
    is_by_change |= by_change > by_spin;
  }
  EXPECT_TRUE(is_by_spin && is_by_change);
}

}  // namespace
}  // namespace ambient
