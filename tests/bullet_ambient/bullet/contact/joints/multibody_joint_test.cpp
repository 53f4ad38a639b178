#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "bullet_ambient/bullet/members/tree_state.h"
#include "tests/bullet_ambient/bullet/contact/chain_contact.h"

namespace ambient::test {
namespace {

// Joints of btMultiBody between a link and an ambient body, against the dense solution.

enum class JointKind { kPoint, kFixed, kSlider };

btVector3 localOf(const btTransform& pose, const Vector3r& point) {
  return pose.inverse() * toBt(point.cast<double>());
}

struct ChainJoint {
  std::unique_ptr<btMultiBodyConstraint> constraint;
  DenseRobot dense;  // with the rows of the joint
};

// Joint with the body's pivot at `offset` from the link's pivot.
ChainJoint makeJoint(JointKind kind, const ChainTask& task, const Vector3r& offset,
                     const btContactSolverInfo& info) {
  btMultiBody& multibody = task.robot();
  btRigidBody& body = task.body().body();
  const int link = task.link();
  const btVector3 in_link = multibody.worldPosToLocal(link, toBt(task.point().cast<double>()));
  const Vector3r pivot = task.point() + offset;
  const btVector3 in_body = localOf(body.getWorldTransform(), pivot);
  const btMatrix3x3 frame = btMatrix3x3::getIdentity();
  const btVector3 axis(0, 0, 1);
  ChainJoint joint{nullptr, task.dense(info.m_timeStep)};
  Rows& rows = joint.dense.rows;
  switch (kind) {
    case JointKind::kPoint:
      joint.constraint =
          std::make_unique<btMultiBodyPoint2Point>(&multibody, link, &body, in_link, in_body);
      break;
    case JointKind::kFixed:
      joint.constraint = std::make_unique<btMultiBodyFixedConstraint>(
          &multibody, link, &body, in_link, in_body, frame, frame);
      break;
    case JointKind::kSlider:
      joint.constraint = std::make_unique<btMultiBodySliderConstraint>(
          &multibody, link, &body, in_link, in_body, frame, frame, axis);
      break;
  }
  joint.constraint->setMaxAppliedImpulse(btScalar(1e6));
  const Vector3r slide = exact(multibody.localDirToWorld(link, axis));
  for (int i : {0, 1, 2}) {
    // Slider: rows across its free axis.
    Vector3r direction = Vector3r::Unit(i);
    if (kind == JointKind::kSlider) {
      if (i == 2) break;
      const Vector3r across = slide.unitOrthogonal();
      direction = i == 0 ? across : Vector3r(slide.cross(across));
    }
    // Body and link have different pivots.
    reference::DenseRow row = task.row(direction);
    const Vector3r centre = exact(body.getWorldTransform().getOrigin());
    row.jacobian_a.head<3>() = (pivot - centre).cross(direction);
    row.target = -offset.dot(direction) * info.m_erp / info.m_timeStep;
    rows.push_back(row);
  }
  if (kind == JointKind::kPoint) return joint;
  for (int i : {0, 1, 2}) rows.push_back(task.spinRow(Vector3r::Unit(i)));
  return joint;
}

// Error correction in the tests. Bullet measures angular errors in axes of its own: 0 makes these
// axes irrelevant.
double correction(JointKind kind) { return kind == JointKind::kPoint ? 0.2 : 0; }

class MultiBodyJoint : public ::testing::TestWithParam<JointKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, MultiBodyJoint,
                         ::testing::Values(JointKind::kPoint, JointKind::kFixed,
                                           JointKind::kSlider),
                         [](const auto& kind) {
                           return kind.param == JointKind::kPoint   ? "Point"
                                  : kind.param == JointKind::kFixed ? "Fixed"
                                                                    : "Slider";
                         });

TEST_P(MultiBodyJoint, EqualsTheDenseSolution) {
  Arbitrary arbitrary(54);
  double worst = 0;
  int solved = 0;
  for (int i = 0; i < 300; ++i) {
    ChainTask task = arbitraryChainTask(arbitrary, i % 2 == 0);
    btContactSolverInfo info = chainSettings(pushedTime(arbitrary, task));
    info.m_erp = btScalar(correction(GetParam()));
    const Vector3r offset = arbitrary.vector(0.1 * info.m_timeStep).cast<Real>();
    const BeforeChain before(task);
    const ChainJoint joint = makeJoint(GetParam(), task, offset, info);
    const auto expected = reference::solveDense(joint.dense.bodies, joint.dense.rows);
    if (!task.solve(info, joint.constraint.get())) continue;
    ++solved;
    worst = std::max(worst, before.error(task, expected));
  }
  EXPECT_GT(solved, 50);
  EXPECT_LT(worst, kLinkTolerance);
}

TEST_P(MultiBodyJoint, WarmStartsChangeNothingButTheWay) {
  Arbitrary arbitrary(56);
  double worst = 0;
  int solved = 0;
  for (int i = 0; i < 500; ++i) {
    ChainTask task = arbitraryChainTask(arbitrary, i % 2 == 0);
    btContactSolverInfo info = chainSettings(task.body().gyroscopicTime(0.02));
    info.m_solverMode |= SOLVER_USE_ARTICULATED_WARMSTARTING;
    const DenseVector6 first = task.body().velocity();
    const Eigen::VectorXd first_rates = velocityOf(task.robot());
    const ChainJoint joint = makeJoint(GetParam(), task, Vector3r::Zero(), info);
    if (!task.solve(info, joint.constraint.get())) continue;
    task.body().setVelocity(arbitrary.between(0.5, 2) * first);
    writeVelocity(task.robot(), first_rates);
    const BeforeChain before(task);
    const auto expected =
        reference::solveDense(task.dense(info.m_timeStep).bodies, joint.dense.rows);
    if (!task.solve(info, joint.constraint.get())) continue;
    ++solved;
    worst = std::max(worst, before.error(task, expected));
  }
  EXPECT_GT(solved, 50);
  EXPECT_LT(worst, kLinkTolerance);
}

}  // namespace
}  // namespace ambient::test
