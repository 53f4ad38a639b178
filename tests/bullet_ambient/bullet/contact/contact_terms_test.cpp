#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "bullet_ambient/bullet/rows/constraint_rows.h"
#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"

namespace ambient::test {
namespace {

// Normal rows of contacts with Bullet's further terms, against the dense solution: position errors,
// softness, warm starts and split impulses.

// Least friction of a contact: 0, except for Lemke's solver, which needs bounds of friction.
template <class Kind>
constexpr double kLeastFriction = kFrictionBound<Kind> == FrictionBound::kNothing ? 0.3 : 0;

// One contact with three rows, or two contacts with one row each. Three rows each would be
// dependent: the distance of two points of a rigid body is constant.
template <class Kind>
ContactPair pairWithContacts(Arbitrary& arbitrary, Other other) {
  ContactPair pair = arbitraryPair(arbitrary, other);
  if (kLeastFriction<Kind> == 0) pair.addPoint(arbitrary);
  for (int i = 0; i < pair.points(); ++i)
    pair.point(i).m_combinedFriction = btScalar(kLeastFriction<Kind>);
  return pair;
}

// Target velocity of a normal row: closes a gap within the step, or opens a penetration by its part
// `erp`.
Real positionTarget(const btManifoldPoint& point, const btContactSolverInfo& info, Real erp) {
  const Real distance = Real(point.getDistance()) + info.m_linearSlop;
  return distance > 0 ? -distance / info.m_timeStep : -distance * erp / info.m_timeStep;
}

// Rows of all points with `targets` for the normal rows; friction impulses within -+ `friction`.
Rows rowsOf(ContactPair& pair, const std::vector<Real>& targets, Real friction) {
  Rows rows;
  for (int i = 0; i < pair.points(); ++i) {
    rows.push_back(pair.row(pair.normal(i), i));
    rows.back().target = targets[i];
    rows.back().lower = 0;
    if (friction == 0) continue;
    for (int t : {0, 1}) {
      rows.push_back(pair.row(pair.tangent(t, i), i));
      rows.back().lower = -friction;
      rows.back().upper = friction;
    }
  }
  return rows;
}

std::vector<reference::DenseBody> atRest(std::vector<reference::DenseBody> bodies) {
  for (reference::DenseBody& body : bodies) body.free_velocity.setZero();
  return bodies;
}

Matrix3r rotation(const Vector3r& vector) {
  const Real angle = vector.norm();
  return angle > 0 ? Eigen::AngleAxis<Real>(angle, vector / angle).toRotationMatrix()
                   : Matrix3r(Matrix3r::Identity());
}

// Poses of a pair before a step.
struct PosesBefore {
  explicit PosesBefore(const ContactPair& pair)
      : a(pair.a().body().getWorldTransform()), b(pair.b().body().getWorldTransform()) {}

  // Returns the error of the displacement by push velocities. Unit: the body's size, or its
  // distance from the world's origin, which determines rounding.
  double error(const ContactPair& pair, const reference::DenseSolution& pushed,
               const btContactSolverInfo& info) const {
    const auto of_one = [&](const CoupledBody& body, const btTransform& start,
                            const DenseVector6& push) {
      const btTransform& end = body.body().getWorldTransform();
      const Vector3r origin = exact(start.getOrigin());
      const Vector3r at = origin + info.m_timeStep * push.tail<3>();
      // Bullet limits the turn of a step to a quarter of pi.
      Vector3r turn = info.m_timeStep * info.m_splitImpulseTurnErp * push.head<3>();
      turn *= std::min<Real>(1, std::acos(Real(-1)) / 4 / std::max<Real>(turn.norm(), 1e-30L));
      const Matrix3r turned = rotation(turn) * exact(start.getBasis());
      return static_cast<double>(
          std::max((exact(end.getOrigin()) - at).norm() / std::max<Real>(body.size(), at.norm()),
                   (exact(end.getBasis()) - turned).norm()));
    };
    const double of_a = of_one(pair.a(), a, pushed.velocities[0]);
    return pair.b().isFixed() ? of_a : std::max(of_a, of_one(pair.b(), b, pushed.velocities[1]));
  }

  btTransform a, b;
};

template <class Kind>
class ContactTerms : public ::testing::Test {};
TYPED_TEST_SUITE(ContactTerms, AllSolvers, SolverName);

TYPED_TEST(ContactTerms, PositionErrorsSoftnessAndRelaxationEqualTheDenseSolution) {
  expectErrors(41, 300, 150, kTolerance, [](Arbitrary& arbitrary, int i) -> CaseError {
    ContactPair pair = pairWithContacts<TypeParam>(arbitrary, kOthers[i % 3]);
    btContactSolverInfo info = convergingSettings(gyroscopicTime(pair, 0.05));
    pushAtRandom(arbitrary, pair, info.m_timeStep);
    info.m_erp2 = btScalar(arbitrary.between(0, 1));
    info.m_linearSlop = btScalar(0.02 * pair.a().size());
    info.m_sor = btScalar(arbitrary.between(0.7, 1.3));
    const auto bodies = pair.dense(info.m_timeStep);
    const reference::DenseRow first = pair.row(pair.normal());
    const Real response = reference::response(bodies, first, first);
    info.m_globalCfm = btScalar(arbitrary.between(0, 1) * info.m_timeStep * response);
    const Before before(pair);
    const auto approachAt = [&](int p) {
      return pair.approach(pair.normal(p), before.a, before.b, p);
    };
    // Where other points move apart, iterations without the bounces would push them.
    const bool bounces = approachAt(0) < 0 && approachAt(pair.points() - 1) < 0;
    const Real restitution = bounces ? Real(i / 3 % 3 * 0.5) : Real(0);
    std::vector<Real> targets;
    for (int p = 0; p < pair.points(); ++p) {
      btManifoldPoint& point = pair.point(p);
      point.m_combinedRestitution = btScalar(restitution);
      const Real approach = approachAt(p);
      point.m_distance1 = btScalar(arbitrary.between(-1, 1) * info.m_timeStep * std::abs(approach));
      const reference::DenseRow row = pair.row(pair.normal(p), p);
      Real push = row.jacobian_a.dot(bodies[0].free_velocity - before.a);
      if (pair.b().isAmbient()) push += row.jacobian_b.dot(bodies[1].free_velocity - before.b);
      targets.push_back(
          contactTarget(-restitution * approach, push, positionTarget(point, info, info.m_erp2)));
    }
    Rows rows = rowsOf(pair, targets, btScalar(kLeastFriction<TypeParam>));
    for (reference::DenseRow& row : rows) row.softness = Real(info.m_globalCfm) / info.m_timeStep;
    const auto expected = reference::solveDense(bodies, rows);
    if (!touch(expected) || reference::independence(bodies, rows) < kIndependent)
      return std::nullopt;
    if (!pair.template solve<TypeParam>(info)) return std::nullopt;
    return worstError(pair, expected, before);
  });
}

// The second solve starts from impulses of the first one, at a different velocity.
TYPED_TEST(ContactTerms, WarmStartsChangeNothingButTheWay) {
  expectErrors(42, 300, 100, kTolerance, [](Arbitrary& arbitrary, int i) -> CaseError {
    ContactPair pair = pairWithContacts<TypeParam>(arbitrary, kOthers[i % 3]);
    btContactSolverInfo info = convergingSettings(gyroscopicTime(pair, 0.02));
    info.m_solverMode |= SOLVER_USE_WARMSTARTING;
    const Before first(pair);
    if (!pair.template solve<TypeParam>(info)) return std::nullopt;
    const bool began_warm = pair.point().m_appliedImpulse > 0;
    pair.setVelocities(first.a, arbitrary.between(0.3, 2) * first.b);
    pair.makeApproaching();
    pushAtRandom(arbitrary, pair, info.m_timeStep);
    const Before before(pair);
    const auto bodies = pair.dense(info.m_timeStep);
    const Rows rows = rowsOf(pair, std::vector<Real>(2, 0), btScalar(kLeastFriction<TypeParam>));
    const auto expected = reference::solveDense(bodies, rows);
    if (!began_warm || !touch(expected)) return std::nullopt;
    if (reference::independence(bodies, rows) < kIndependent) return std::nullopt;
    if (!pair.template solve<TypeParam>(info)) return std::nullopt;
    return worstError(pair, expected, before);
  });
}

template <class Kind>
class IteratedContactTerms : public ::testing::Test {};
using IteratingSolvers =
    ::testing::Types<SequentialImpulse, ConjugateGradient, Multithreaded, MultiBody>;
TYPED_TEST_SUITE(IteratedContactTerms, IteratingSolvers, SolverName);

// Without warm starting, one iteration over two contacts leaves gaps open.
TYPED_TEST(IteratedContactTerms, AWarmStartFromTheSolutionNeedsOneIteration) {
  expectErrors(43, 150, 75, kTolerance, [](Arbitrary& arbitrary, int i) -> CaseError {
    ContactPair pair = pairWithContacts<TypeParam>(arbitrary, kOthers[i % 3]);
    btContactSolverInfo info = convergingSettings(gyroscopicTime(pair, 0.05));
    info.m_solverMode |= SOLVER_USE_WARMSTARTING;
    info.m_warmstartingFactor = 1;
    const Before before(pair);
    const auto bodies = pair.dense(info.m_timeStep);
    const Rows rows = rowsOf(pair, std::vector<Real>(2, 0), 0);
    const auto expected = reference::solveDense(bodies, rows);
    if (!touch(expected) || reference::independence(bodies, rows) < kIndependent)
      return std::nullopt;
    if (!pair.template solve<TypeParam>(info)) return std::nullopt;
    pair.setVelocities(before.a, before.b);
    info.m_numIterations = 1;
    info.m_leastSquaresResidualThreshold = 0;
    pair.template solve<TypeParam>(info);
    return worstError(pair, expected, before);
  });
}

// Push velocities correct the position, without a change of the velocities.
TYPED_TEST(ContactTerms, SplitImpulsesPushAsTheDenseSolution) {
  Arbitrary arbitrary(44);
  double worst = 0, worst_pose = 0;
  int solved = 0;
  for (int i = 0; i < 300; ++i) {
    ContactPair pair = pairWithContacts<TypeParam>(arbitrary, kOthers[i % 3]);
    btContactSolverInfo info = convergingSettings(gyroscopicTime(pair, 0.05));
    pushAtRandom(arbitrary, pair, info.m_timeStep);
    info.m_splitImpulse = 1;
    info.m_splitImpulsePenetrationThreshold = 0;
    info.m_splitImpulseTurnErp = btScalar(arbitrary.between(0.1, 1));
    info.m_erp2 = btScalar(arbitrary.between(0.2, 1));
    std::vector<Real> push_targets;
    for (int p = 0; p < pair.points(); ++p) {
      pair.point(p).m_distance1 = btScalar(-arbitrary.between(0.01, 0.1) * pair.a().size());
      push_targets.push_back(positionTarget(pair.point(p), info, info.m_erp2));
    }
    const Before before(pair);
    const PosesBefore poses(pair);
    const auto bodies = pair.dense(info.m_timeStep);
    const Rows rows = rowsOf(pair, std::vector<Real>(2, 0), btScalar(kLeastFriction<TypeParam>));
    const Rows pushes = rowsOf(pair, push_targets, btScalar(kLeastFriction<TypeParam>));
    const auto expected = reference::solveDense(bodies, rows);
    const auto pushed = reference::solveDense(atRest(bodies), pushes);
    if (reference::independence(bodies, rows) < kIndependent) continue;
    if (!pair.template solve<TypeParam>(info)) continue;
    ++solved;
    worst = std::max(worst, worstError(pair, expected, before));
    worst_pose = std::max(worst_pose, poses.error(pair, pushed, info));
  }
  EXPECT_GT(solved, 150);
  EXPECT_LT(worst, kTolerance);
  EXPECT_LT(worst_pose, kTolerance);
}

// Rows between two bodies, or a body and what cannot move, by any numbers.
class RandomRows {
 public:
  btSolverBody body(bool moves) {
    btSolverBody body;
    std::memset(static_cast<void*>(&body), 0, sizeof body);
    if (moves) body.m_originalBody = &original_;
    for (btVector3* v : {&body.m_angularFactor, &body.m_linearFactor}) *v = {1, 1, 1};
    if (number() > 0) body.m_linearFactor = {1, 0, 1};
    const btScalar inverse_mass = moves ? 1 + number() * number() : 0;
    body.m_invMass = btVector3(1, 1, 1) * inverse_mass;
    if (moves) {
      body.m_deltaLinearVelocity = vector();
      body.m_deltaAngularVelocity = vector();
    }
    return body;
  }

  btSolverConstraint row() {
    btSolverConstraint row;
    std::memset(static_cast<void*>(&row), 0, sizeof row);
    for (btVector3* v :
         {&row.m_relpos1CrossNormal, &row.m_contactNormal1, &row.m_relpos2CrossNormal,
          &row.m_contactNormal2, &row.m_angularComponentA, &row.m_angularComponentB})
      *v = vector();
    row.m_appliedImpulse = number() * number();
    row.m_jacDiagABInv = btScalar(0.1) + number() * number();
    row.m_rhs = number();
    row.m_cfm = btScalar(0.1) * number();
    row.m_lowerLimit = number() > 0 ? -1 : 0;
    row.m_upperLimit = number() > 0 ? btScalar(0.2) : btScalar(1e10);
    row.m_friction = btScalar(0.5);
    return row;
  }

 private:
  btScalar number() { return static_cast<btScalar>(normal_(engine_)); }
  btVector3 vector() {
    const btScalar x = number(), y = number(), z = number();
    return {x, y, z};
  }

  std::mt19937 engine_{7};
  std::normal_distribution<double> normal_;
  btSphereShape sphere_{1};
  btRigidBody original_{1, nullptr, &sphere_};
};

bool isSame(btScalar a, btScalar b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool isSame(const btVector3& a, const btVector3& b) {
  return isSame(a.x(), b.x()) && isSame(a.y(), b.y()) && isSame(a.z(), b.z());
}

bool isSame(const btSolverBody& a, const btSolverBody& b) {
  return isSame(a.m_deltaLinearVelocity, b.m_deltaLinearVelocity) &&
         isSame(a.m_deltaAngularVelocity, b.m_deltaAngularVelocity);
}

// Expects the bits of Bullet's function.
void expectSame(btSingleConstraintRowSolver quick, btSingleConstraintRowSolver stock) {
  RandomRows random;
  for (int i = 0; i < 2000; ++i) {
    const btSolverBody bodies[2] = {random.body(true), random.body(i % 4 != 0)};
    const btSolverConstraint given = random.row();
    btSolverBody a[2] = {bodies[0], bodies[0]}, b[2] = {bodies[1], bodies[1]};
    const btSolverConstraint row[2] = {given, given};
    const btScalar residuals[2] = {stock(a[0], b[0], row[0]), quick(a[1], b[1], row[1])};
    ASSERT_TRUE(isSame(residuals[0], residuals[1])) << "residual of row " << i;
    ASSERT_TRUE(isSame(row[0].m_appliedImpulse, row[1].m_appliedImpulse)) << "impulse of row " << i;
    ASSERT_TRUE(isSame(a[0], a[1]) && isSame(b[0], b[1])) << "velocities of row " << i;
  }
}

TEST(QuickRows, HaveTheBitsOfBullets) {
  btSequentialImpulseConstraintSolver solver;
  expectSame(quickRows().generic, solver.getScalarConstraintRowSolverGeneric());
  expectSame(quickRows().lower_limit, solver.getScalarConstraintRowSolverLowerLimit());
}

}  // namespace
}  // namespace ambient::test
