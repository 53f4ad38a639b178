#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"

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
  Arbitrary arbitrary(45);
  double worst = 0;
  int solved = 0;
  for (int i = 0; i < 300; ++i) {
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
    if (!expected || !(expected->impulses[0] > 1e-9L)) continue;
    if (!pair.template solve<TypeParam>(info)) continue;
    ++solved;
    worst = std::max(worst, worstError(pair, *expected, before));
  }
  EXPECT_GT(solved, 200);
  EXPECT_LT(worst, kTolerance);
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

}  // namespace
}  // namespace ambient::test
