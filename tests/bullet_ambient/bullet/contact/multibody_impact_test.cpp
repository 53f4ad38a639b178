#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/members/tree_state.h"
#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"
#include "tests/bullet_ambient/bullet/robots/link_reference.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

namespace ambient::test {
namespace {

// Contacts of an ambient body with a link of a dry btMultiBody. The reference has links as separate
// bodies with joint rows.

// An ambient or ordinary body that touches a dry robot of three links; calls a solver for
// multibodies without a world. The reference has the robot's bodies, then the body.
class ChainTask {
 public:
  /// Moves the body so that its surface point meets the surface point of a link, or of the base,
  /// which is link -1.
  ChainTask(Arbitrary& arbitrary, bool has_fixed_base, int link)
      : body_(CoupledBody::random(arbitrary, arbitraryRatio(arbitrary))), link_(link) {
    RobotDef def;
    def.joints = Joints::kSmooth;
    def.has_fixed_base = has_fixed_base;
    robot_ = arbitraryRobot(arbitrary, def);
    for (int i = -1; i < robot_->getNumLinks(); ++i)
      colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(robot_.get(), i));
    // Repeats the world's preparation before its solver call; advances no time.
    RobotWorld::moveColliders(*robot_);
    btAlignedObjectArray<btVector3> vectors;
    btAlignedObjectArray<btScalar> scalars;
    btAlignedObjectArray<btMatrix3x3> matrices;
    robot_->computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scalars, vectors, matrices,
                                                                 false, false, false);
    point_ = exact(robot_->localPosToWorld(link, {0, 0, 0})) + arbitrary.vector(0.15).cast<Real>();
    const Vector3 centre = point_.cast<double>() + arbitrary.vector(body_.size() / 2);
    btTransform pose = body_.body().getWorldTransform();
    pose.setOrigin(toBt(centre));
    body_.body().setWorldTransform(pose);
  }

  const CoupledBody& body() const { return body_; }
  btMultiBody& robot() const { return *robot_; }
  int link() const { return link_; }
  Vector3r point() const { return point_; }  ///< contact point, world

  /// Adds a contact with the body as A, or as B; random normal along which the bodies approach.
  void touch(Arbitrary& arbitrary, bool body_is_a) {
    touchAlong(toBt(arbitrary.vector()).normalized(), body_is_a);
  }
  void touchAlong(const btVector3& normal_or_opposite, bool body_is_a) {
    body_is_a_ = body_is_a;
    btCollisionObject* a = &body_.body();
    btCollisionObject* b = colliders_[static_cast<std::size_t>(link_ + 1)].get();
    if (!body_is_a) std::swap(a, b);
    manifold_ = std::make_unique<btPersistentManifold>(a, b, 0, btScalar(1), btScalar(1));
    const btVector3 at = toBt(point_.cast<double>());
    point_ = exact(at);
    for (const btScalar sign : {btScalar(1), btScalar(-1)}) {
      btManifoldPoint point({0, 0, 0}, {0, 0, 0}, sign * normal_or_opposite, 0);
      point.m_positionWorldOnA = point.m_positionWorldOnB = at;
      manifold_->clearManifold();
      manifold_->addManifoldPoint(point);
      if (approach() < 0) return;
    }
  }
  btManifoldPoint& contact() { return manifold_->getContactPoint(0); }
  Real approach() const {
    const reference::DenseRow r = row(exact(manifold_->getContactPoint(0).m_normalWorldOnB));
    return r.jacobian_a.dot(body_.velocity()) +
           r.jacobian_b.dot(twistsOf(*robot_)[static_cast<std::size_t>(link_ + 1)]);
  }

  /// Row along a direction at the contact, with the signs of Bullet's rows.
  reference::DenseRow row(const Vector3r& direction) const {
    return oriented(
        reference::pointRow(direction, point_ - exact(body_.body().getWorldTransform().getOrigin()),
                            point_ - exact(robot_->localPosToWorld(link_, {0, 0, 0}))));
  }
  reference::DenseRow spinRow(const Vector3r& direction) const {
    return oriented(reference::spinRow(direction));
  }
  /// Reference before a step of dt, with the rows of the robot's joints.
  DenseRobot dense(Real dt) const {
    static const RobotWorld nobody;  // the robot is in no fluid
    DenseRobot dense = denseRobot(*robot_, nobody.fluid);
    dense.bodies.push_back(body_.dense(dt));
    return dense;
  }
  int denseBody() const { return robot_->getNumLinks() + 2; }    ///< number of the body in dense()
  int denseGround() const { return robot_->getNumLinks() + 1; }  ///< number of what never moves

  /// Returns false if the residual stays above the threshold of the settings.
  bool solve(const btContactSolverInfo& info, btMultiBodyConstraint* joint = nullptr) {
    const auto members = std::make_shared<AmbientBodies>();
    body_.attachTo(*members);
    MultiBody::Ambient ambient(members);
    std::vector<btCollisionObject*> bodies = {&body_.body()};
    for (const auto& collider : colliders_) bodies.push_back(collider.get());
    btPersistentManifold* manifolds[] = {manifold_.get()};
    ambient.solver.solveMultiBodyGroup(bodies.data(), static_cast<int>(bodies.size()), manifolds,
                                       manifold_ ? 1 : 0, nullptr, 0, joint ? &joint : nullptr,
                                       joint ? 1 : 0, info, nullptr, nullptr);
    robot_->processDeltaVeeMultiDof2();  // the world's next call
    return hasFinished(ambient.solver, info);
  }

 private:
  reference::DenseRow oriented(reference::DenseRow row) const {
    row.body_a = denseBody();
    row.body_b = link_ + 1;
    if (!body_is_a_) {
      row.jacobian_a *= -1;
      row.jacobian_b *= -1;
    }
    return row;
  }

  CoupledBody body_;
  std::unique_ptr<btMultiBody> robot_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;  // of the base first
  int link_;
  Vector3r point_;
  bool body_is_a_ = true;
  std::unique_ptr<btPersistentManifold> manifold_;
};

// Tolerance of links. Bullet's recursion in float32 loses digits: 3e-5 for one of 600 chains, 8e-6
// with ordinary bodies instead of ambient ones.
constexpr double kLinkTolerance = sizeof(btScalar) == 8 ? kTolerance : 5e-5;

// Velocities before a step, and the larger error of body and robot after it.
struct BeforeChain {
  explicit BeforeChain(const ChainTask& task)
      : body(task.body().velocity()), robot(twistsOf(task.robot())) {}
  double error(const ChainTask& task, const reference::DenseSolution& expected) const {
    return std::max(
        task.body().error(expected.velocities[static_cast<std::size_t>(task.denseBody())], body),
        twistError(task.robot(), expected.velocities, robot));
  }
  DenseVector6 body;
  std::vector<DenseVector6> robot;
};

// An ambient body that touches a random movable link of a robot with a free or fixed base.
ChainTask arbitraryChainTask(Arbitrary& arbitrary, bool has_fixed_base) {
  const int link = static_cast<int>(arbitrary.between(has_fixed_base ? 1 : 0, 4)) - 1;
  return {arbitrary, has_fixed_base, std::min(link, 2)};
}

// Applies random forces and torques. Returns the step for which they and the gyroscopic terms
// change the body's velocity by 5 %.
double pushedTime(Arbitrary& arbitrary, const ChainTask& task) {
  const CoupledBody& body = task.body();
  const double dt = body.gyroscopicTime(0.05);
  const double push = 0.05 / (dt * static_cast<double>(body.body().getInvMass()));
  body.body().applyCentralForce(toBt(arbitrary.vector(push)));
  body.body().applyTorque(toBt(arbitrary.vector(push * body.size())));
  return dt;
}

// convergingSettings() with 300 iterations at most: rows that need more are nearly dependent, and
// rounding decides the split between impulses.
btContactSolverInfo chainSettings(double dt) {
  btContactSolverInfo info = convergingSettings(dt);
  info.m_numIterations = 300;
  return info;
}

// Adds the rows of the contact, its normal first, with friction in a box along `directions`
// tangents. Returns the number of the normal's.
std::size_t addBoxContact(ChainTask& task, int directions, Rows& rows) {
  const btManifoldPoint& contact = task.contact();
  const std::size_t normal = rows.size();
  rows.push_back(task.row(exact(contact.m_normalWorldOnB)));
  rows[normal].lower = 0;
  btVector3 tangent[2];
  btPlaneSpace1(contact.m_normalWorldOnB, tangent[0], tangent[1]);
  for (int t = 0; t < directions; ++t) {
    rows.push_back(task.row(exact(tangent[t])));
    rows.back().friction = contact.m_combinedFriction;
    rows.back().normal_row = static_cast<int>(normal);
  }
  return normal;
}

// Restitution, position error, softness of contact and friction, friction in a box.
TEST(MultiBodyImpact, WithSoftBoxFrictionEqualsTheDenseSolution) {
  Arbitrary arbitrary(52);
  double worst = 0;
  int sticking = 0, sliding = 0;
  for (int i = 0; i < 200; ++i) {
    ChainTask task = arbitraryChainTask(arbitrary, i % 2 == 0);
    task.touch(arbitrary, i / 2 % 2 == 0);
    btContactSolverInfo info = chainSettings(pushedTime(arbitrary, task));
    info.m_solverMode |= SOLVER_DISABLE_IMPLICIT_CONE_FRICTION;
    info.m_sor = btScalar(arbitrary.between(0.8, 1.2));
    info.m_erp2 = btScalar(arbitrary.between(0, 0.5));
    info.m_globalCfm = btScalar(arbitrary.between(0, 0.5) * info.m_timeStep);
    info.m_frictionCFM = btScalar(arbitrary.between(0, 0.5) * info.m_timeStep);
    btManifoldPoint& contact = task.contact();
    contact.m_combinedFriction = btScalar(arbitrary.between(0.05, 0.6));
    contact.m_distance1 = btScalar(-0.1 * info.m_timeStep);
    const double restitution = i / 4 % 3 * 0.5;
    contact.m_combinedRestitution = btScalar(restitution);
    const BeforeChain before(task);
    auto [bodies, rows] = task.dense(info.m_timeStep);
    const std::size_t normal = addBoxContact(task, 2, rows);
    const auto of_body = static_cast<std::size_t>(task.denseBody());
    const Real push = rows[normal].jacobian_a.dot(bodies[of_body].free_velocity - before.body);
    rows[normal].target = contactTarget(-restitution * task.approach(), push,
                                        -Real(contact.m_distance1) * info.m_erp2 / info.m_timeStep);
    rows[normal].softness = Real(info.m_globalCfm) / info.m_timeStep;
    for (int t : {1, 2}) rows[normal + t].softness = Real(info.m_frictionCFM) / info.m_timeStep;
    const auto expected = reference::onlySolution(bodies, rows);
    if (!expected || !(expected->impulses[normal] > 1e-9L)) continue;
    if (!task.solve(info)) continue;
    for (int t : {1, 2}) {
      const Real bound = rows[normal + t].friction * expected->impulses[normal];
      ++(std::abs(expected->impulses[normal + t]) < bound * (1 - 1e-12L) ? sticking : sliding);
    }
    worst = std::max(worst, before.error(task, *expected));
  }
  EXPECT_GT(sticking, 50);
  EXPECT_GT(sliding, 50);
  EXPECT_LT(worst, kLinkTolerance);
}

// Rows that fix the locked axes of the body against the ground.
Rows planeRows(const ChainTask& task) {
  Rows rows;
  for (int axis : {0, 1, 5}) {
    reference::DenseRow row;
    row.body_a = task.denseBody();
    row.body_b = task.denseGround();
    row.jacobian_a[axis] = 1;
    rows.push_back(row);
  }
  return rows;
}

// A 2D body on a moving or static multibody; grounds loaded from files are static multibodies.
// There one friction direction acts along locked axes alone.
TEST(MultiBodyImpact, WithLockedAxesEqualsTheDenseSolution) {
  Arbitrary arbitrary(57);
  double worst = 0;
  int solved = 0, on_ground = 0;
  for (int i = 0; i < 200; ++i) {
    const bool is_ground = i % 2 == 0;
    ChainTask task(arbitrary, is_ground, is_ground ? -1 : 1);
    btRigidBody& body = task.body().body();
    body.setLinearFactor({1, 1, 0});
    body.setAngularFactor({0, 0, 1});
    body.setLinearVelocity(body.getLinearVelocity() * body.getLinearFactor());
    body.setAngularVelocity(body.getAngularVelocity() * body.getAngularFactor());
    const btVector3 direction(btScalar(arbitrary.between(-1, 1)),
                              btScalar(arbitrary.between(-1, 1)), 0);
    task.touchAlong(direction.normalized(), i / 2 % 2 == 0);
    // Step so short that forces and gyroscopic terms vanish.
    btContactSolverInfo info = chainSettings(task.body().gyroscopicTime(1e-18));
    info.m_solverMode |= SOLVER_DISABLE_IMPLICIT_CONE_FRICTION;
    task.contact().m_combinedFriction = btScalar(0.3);
    const BeforeChain before(task);
    auto [bodies, rows] = task.dense(info.m_timeStep);
    for (const reference::DenseRow& row : planeRows(task)) rows.push_back(row);
    const std::size_t normal = addBoxContact(task, is_ground ? 1 : 2, rows);
    const auto expected = reference::onlySolution(bodies, rows);
    if (!expected || !(expected->impulses[normal] > 1e-9L)) continue;
    const bool has_finished = task.solve(info);
    ASSERT_TRUE(task.body().velocity().allFinite());
    if (!has_finished) continue;
    ++solved;
    on_ground += is_ground;
    worst = std::max(worst, before.error(task, *expected));
  }
  EXPECT_GT(solved, 100);
  EXPECT_GT(on_ground, 60);
  EXPECT_LT(worst, kLinkTolerance);
}

// Large coefficients: contacts between a link and a body neither slide nor roll nor spin. All rows
// of the contact act, in Bullet's default mode with cones of friction.
TEST(MultiBodyImpact, StickingRollingAndSpinningRowsEqualTheDenseSolution) {
  expectErrors(53, 300, 50, kLinkTolerance, [](Arbitrary& arbitrary, int i) -> CaseError {
    ChainTask task = arbitraryChainTask(arbitrary, i % 2 == 0);
    task.touch(arbitrary, i / 2 % 2 == 0);
    const btContactSolverInfo info = chainSettings(pushedTime(arbitrary, task));
    btManifoldPoint& contact = task.contact();
    contact.m_combinedFriction = btScalar(1e6);
    contact.m_combinedSpinningFriction = btScalar(1e6);
    contact.m_combinedRollingFriction = btScalar(1e6);
    const BeforeChain before(task);
    auto [bodies, rows] = task.dense(info.m_timeStep);
    const auto normal = rows.size();
    rows.push_back(task.row(exact(contact.m_normalWorldOnB)));
    btVector3 tangent[2];
    btPlaneSpace1(contact.m_normalWorldOnB, tangent[0], tangent[1]);
    for (const btVector3& direction : tangent) rows.push_back(task.row(exact(direction)));
    for (const btVector3& direction : tangent) rows.push_back(task.spinRow(exact(direction)));
    rows.push_back(task.spinRow(exact(contact.m_normalWorldOnB)));
    const auto expected = reference::solveDense(bodies, rows);
    if (!(expected.impulses[normal] > 1e-3L)) return std::nullopt;
    if (!task.solve(info)) return std::nullopt;
    // Bullet keeps rolling and spinning impulses of a contact with an impulse that
    // became 0 during iterations. Ordinary bodies show it, too; skipped.
    if (contact.m_appliedImpulse == 0) return std::nullopt;
    return before.error(task, expected);
  });
}

// The second solve starts from impulses of the first one, at different velocities.
TEST(MultiBodyImpact, WarmStartsChangeNothingButTheWay) {
  expectErrors(55, 300, 150, kLinkTolerance, [](Arbitrary& arbitrary, int i) -> CaseError {
    ChainTask task = arbitraryChainTask(arbitrary, i % 2 == 0);
    task.touch(arbitrary, i / 2 % 2 == 0);
    btContactSolverInfo info = chainSettings(task.body().gyroscopicTime(0.02));
    info.m_solverMode |= SOLVER_USE_ARTICULATED_WARMSTARTING;
    const DenseVector6 first = task.body().velocity();
    const Eigen::VectorXd first_rates = velocityOf(task.robot());
    if (!task.solve(info)) return std::nullopt;
    task.body().setVelocity(arbitrary.between(0.8, 1.2) * first);
    writeVelocity(task.robot(), first_rates);
    const BeforeChain before(task);
    auto [bodies, rows] = task.dense(info.m_timeStep);
    rows.push_back(task.row(exact(task.contact().m_normalWorldOnB)));
    rows.back().lower = 0;
    const auto expected = reference::solveDense(bodies, rows);
    if (!(expected.impulses[rows.size() - 1] > 1e-9L)) return std::nullopt;
    if (!task.solve(info)) return std::nullopt;
    return before.error(task, expected);
  });
}

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
  expectErrors(54, 300, 50, kLinkTolerance, [](Arbitrary& arbitrary, int i) -> CaseError {
    ChainTask task = arbitraryChainTask(arbitrary, i % 2 == 0);
    btContactSolverInfo info = chainSettings(pushedTime(arbitrary, task));
    info.m_erp = btScalar(correction(GetParam()));
    const Vector3r offset = arbitrary.vector(0.1 * info.m_timeStep).cast<Real>();
    const BeforeChain before(task);
    const ChainJoint joint = makeJoint(GetParam(), task, offset, info);
    const auto expected = reference::solveDense(joint.dense.bodies, joint.dense.rows);
    if (!task.solve(info, joint.constraint.get())) return std::nullopt;
    return before.error(task, expected);
  });
}

TEST_P(MultiBodyJoint, WarmStartsChangeNothingButTheWay) {
  expectErrors(56, 500, 50, kLinkTolerance, [](Arbitrary& arbitrary, int i) -> CaseError {
    ChainTask task = arbitraryChainTask(arbitrary, i % 2 == 0);
    btContactSolverInfo info = chainSettings(task.body().gyroscopicTime(0.02));
    info.m_solverMode |= SOLVER_USE_ARTICULATED_WARMSTARTING;
    const DenseVector6 first = task.body().velocity();
    const Eigen::VectorXd first_rates = velocityOf(task.robot());
    const ChainJoint joint = makeJoint(GetParam(), task, Vector3r::Zero(), info);
    if (!task.solve(info, joint.constraint.get())) return std::nullopt;
    task.body().setVelocity(arbitrary.between(0.5, 2) * first);
    writeVelocity(task.robot(), first_rates);
    const BeforeChain before(task);
    const auto expected =
        reference::solveDense(task.dense(info.m_timeStep).bodies, joint.dense.rows);
    if (!task.solve(info, joint.constraint.get())) return std::nullopt;
    return before.error(task, expected);
  });
}

}  // namespace
}  // namespace ambient::test
