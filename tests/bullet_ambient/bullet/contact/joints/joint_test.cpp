#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

#include "tests/bullet_ambient/bullet/contact/joints/joint_rows.h"

namespace ambient::test {
namespace {

// Joints of an ambient body to a plane, an ordinary body and another ambient body. The reference
// solves the joint's own rows densely with K.

constexpr int kJointsEach = 300;

bool hasSoftRow(const Rows& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.softness != 0; });
}

// Tells if the type has limits, motors or springs.
bool hasBounds(JointType type) {
  return type != JointType::kPointToPoint && type != JointType::kFixed && type != JointType::kGear;
}

// Drops second rows along one direction, for example of the two ends of a range.
Rows distinct(const Rows& rows) {
  Rows result;
  for (const reference::DenseRow& row : rows) {
    const auto is_same = [&](const reference::DenseRow& other) {
      return other.jacobian_a == row.jacobian_a;
    };
    if (std::none_of(result.begin(), result.end(), is_same)) result.push_back(row);
  }
  return result;
}

// Impulse scale of a row: responses to the full velocities of both bodies, without cancellation.
// Rounding is relative to it.
Real impulseScale(const reference::DenseRow& row, const std::vector<reference::DenseBody>& bodies) {
  Real along = row.jacobian_a.cwiseAbs().dot(bodies[0].free_velocity.cwiseAbs());
  if (!bodies[1].fixed) along += row.jacobian_b.cwiseAbs().dot(bodies[1].free_velocity.cwiseAbs());
  return along / reference::response(bodies, row, row);
}

// Largest error of a reported wrench. In float those of rows that almost depend on each other are
// the rounding of the velocities, many times over: of eight other sets of joints, the worst hinge,
// slider or fixed joint of a set is off by 0.7e-6 to 29e-6, most often by 2e-6.
constexpr double kFeedbackTolerance = sizeof(btScalar) == 8 ? kTolerance : 5e-5;

// Difference between Bullet's reported wrench and the reference's, over the impulses of all
// rows.
double feedbackError(const btJointFeedback& feedback, const Rows& rows,
                     const std::vector<reference::DenseBody>& bodies,
                     const reference::DenseSolution& expected, Real size, Real dt) {
  DenseVector6 units = DenseVector6::Ones();
  units.head<3>().setConstant(1 / size);
  DenseVector6 reported, wrench = DenseVector6::Zero();
  reported << dt * exact(feedback.m_appliedTorqueBodyA), dt * exact(feedback.m_appliedForceBodyA);
  Real scale = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    wrench += expected.impulses[r] * rows[r].jacobian_a;
    scale += std::max(std::abs(expected.impulses[r]), impulseScale(rows[r], bodies)) *
             rows[r].jacobian_a.cwiseProduct(units).norm();
  }
  return static_cast<double>((reported - wrench).cwiseProduct(units).norm() / scale);
}

template <class Kind>
class Joint : public ::testing::Test {};
// Excludes conjugate gradients and Lemke in float32: errors up to 1e-4 with ordinary bodies,
// too.
using ExactSolvers =
    ::testing::Types<SequentialImpulse, Dantzig, ProjectedGaussSeidel, Multithreaded, MultiBody>;
using JointSolvers = std::conditional_t<sizeof(btScalar) == 8, AllSolvers, ExactSolvers>;
TYPED_TEST_SUITE(Joint, JointSolvers, SolverName);

TYPED_TEST(Joint, EqualsTheDenseSolution) {
  for (const JointType type : kJointTypes) {
    Arbitrary arbitrary(61);
    double worst = 0, worst_feedback = 0;
    int solved = 0, at_bounds = 0;
    for (int i = 0; i < kJointsEach; ++i) {
      ContactPair pair = arbitraryPair(arbitrary, kOthers[i % 3]);
      btContactSolverInfo info = convergingSettings(gyroscopicTime(pair, 0.05));
      info.m_erp = btScalar(0.2);
      // Spins are 10 times larger than velocities. Conjugate gradients bound impulses instead.
      if (!std::is_same_v<TypeParam, ConjugateGradient>)
        info.m_leastSquaresResidualThreshold *= 100;
      pushAtRandom(arbitrary, pair, info.m_timeStep);
      const auto joint = arbitraryJoint(arbitrary, type, pair);
      btJointFeedback feedback;
      joint->setJointFeedback(&feedback);
      const Before before(pair);
      const auto bodies = pair.dense(info.m_timeStep);
      const Rows rows = jointRows(*joint, bodies, info);
      const Rows directions = distinct(rows);
      if (rows.empty() || reference::independence(bodies, directions) < kIndependent) continue;
      // Bullet's complementarity solvers ignore softness. Two rows along one direction: rounding
      // decides the split.
      if (kIsComplementarity<TypeParam> && (hasSoftRow(rows) || directions.size() < rows.size()))
        continue;
      const auto expected = reference::solveDense(bodies, rows);
      if (!touch(expected)) continue;
      if (!pair.template solve<TypeParam>(info, joint.get())) continue;
      ++solved;
      for (std::size_t r = 0; r < rows.size(); ++r)
        at_bounds += expected.impulses[r] == rows[r].lower || expected.impulses[r] == rows[r].upper;
      worst = std::max(worst, worstError(pair, expected, before));
      worst_feedback = std::max(worst_feedback, feedbackError(feedback, rows, bodies, expected,
                                                              pair.a().size(), info.m_timeStep));
    }
    EXPECT_LT(worst, kTolerance) << nameOf(type);
    EXPECT_LT(worst_feedback, kFeedbackTolerance) << nameOf(type);
    EXPECT_GT(solved, kJointsEach / 4) << nameOf(type);
    EXPECT_GT(at_bounds, hasBounds(type) ? 20 : -1) << nameOf(type);
    report(nameOf(type), worst);
    report(nameOf(type) + "_feedback", worst_feedback);
  }
}

}  // namespace
}  // namespace ambient::test
