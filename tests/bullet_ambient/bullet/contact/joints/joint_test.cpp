#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"

namespace ambient::test {
namespace {

// Joints of an ambient body to a plane, an ordinary body and another ambient body. The reference
// solves the joint's own rows densely with K.

struct Frames {
  btTransform in_a, in_b;
};

btTransform localFrame(const btTransform& body, const btTransform& world) {
  return body.inverse() * world;
}

Frames arbitraryFrames(Arbitrary& arbitrary, const ContactPair& pair) {
  const btRigidBody& a = pair.a().body();
  const btRigidBody& b = pair.b().body();
  const Quaternion q(arbitrary.rotation());
  btTransform world;
  world.setRotation(
      btQuaternion(btScalar(q.x()), btScalar(q.y()), btScalar(q.z()), btScalar(q.w())));
  world.setOrigin(a.getWorldTransform().getOrigin() + toBt(pair.fromA().cast<double>()));
  Frames frames;
  frames.in_a = localFrame(a.getWorldTransform(), world);
  const btVector3 turn = toBt(arbitrary.vector(0.15));
  world.setRotation(btQuaternion(turn.normalized(), turn.length()) * world.getRotation());
  world.getOrigin() += toBt(arbitrary.vector(0.02 * pair.a().size()));
  frames.in_b = localFrame(b.getWorldTransform(), world);
  return frames;
}

// Random impulse of the pair's scale: up to its mass times 1 m/s.
double arbitraryImpulse(Arbitrary& arbitrary, const ContactPair& pair) {
  return arbitrary.between(0.01, 1) / static_cast<double>(pair.a().body().getInvMass());
}

std::unique_ptr<btTypedConstraint> hinge(Arbitrary& arbitrary, const ContactPair& pair,
                                         const Frames& frames) {
  auto joint = std::make_unique<btHingeConstraint>(pair.a().body(), pair.b().body(), frames.in_a,
                                                   frames.in_b);
  const auto low = btScalar(arbitrary.between(-0.4, 0.1));
  joint->setLimit(low, btScalar(low + arbitrary.between(0, 0.5)), btScalar(0.9),
                  btScalar(arbitrary.between(0.1, 0.9)), btScalar(arbitrary.between(0, 1)));
  joint->enableAngularMotor(arbitrary.between(0, 1) < 0.5, btScalar(arbitrary.between(-3, 3)),
                            btScalar(arbitraryImpulse(arbitrary, pair) * pair.a().size()));
  return joint;
}

std::unique_ptr<btTypedConstraint> slider(Arbitrary& arbitrary, const ContactPair& pair,
                                          const Frames& frames) {
  auto joint = std::make_unique<btSliderConstraint>(pair.a().body(), pair.b().body(), frames.in_a,
                                                    frames.in_b, true);
  const double size = pair.a().size();
  joint->setLowerLinLimit(btScalar(arbitrary.between(-0.1, 0.01) * size));
  joint->setUpperLinLimit(btScalar(arbitrary.between(0.01, 0.1) * size));
  joint->setLowerAngLimit(btScalar(arbitrary.between(-0.4, 0)));
  joint->setUpperAngLimit(btScalar(arbitrary.between(0, 0.4)));
  joint->setPoweredLinMotor(arbitrary.between(0, 1) < 0.5);
  joint->setTargetLinMotorVelocity(btScalar(arbitrary.between(-1, 1)));
  joint->setMaxLinMotorForce(btScalar(10 * arbitraryImpulse(arbitrary, pair)));
  joint->setPoweredAngMotor(arbitrary.between(0, 1) < 0.5);
  joint->setTargetAngMotorVelocity(btScalar(arbitrary.between(-3, 3)));
  joint->setMaxAngMotorForce(btScalar(10 * arbitraryImpulse(arbitrary, pair) * size));
  return joint;
}

std::unique_ptr<btTypedConstraint> coneTwist(Arbitrary& arbitrary, const ContactPair& pair,
                                             const Frames& frames) {
  auto joint = std::make_unique<btConeTwistConstraint>(pair.a().body(), pair.b().body(),
                                                       frames.in_a, frames.in_b);
  joint->setLimit(btScalar(arbitrary.between(0.1, 0.5)), btScalar(arbitrary.between(0.1, 0.5)),
                  btScalar(arbitrary.between(0.1, 0.5)), btScalar(arbitrary.between(0.5, 1)),
                  btScalar(0.3), btScalar(arbitrary.between(0.1, 1)));
  if (arbitrary.between(0, 1) < 0.5) {
    joint->enableMotor(true);
    joint->setMaxMotorImpulse(btScalar(arbitraryImpulse(arbitrary, pair) * pair.a().size()));
    joint->setMotorTarget(btQuaternion(btVector3(0, 1, 0), btScalar(arbitrary.between(-1, 1))));
  }
  return joint;
}

template <class Joint>
void setLimits(Arbitrary& arbitrary, const ContactPair& pair, Joint& joint) {
  const double size = pair.a().size();
  for (int axis = 0; axis < 6; ++axis) {
    const double scale = axis < 3 ? 0.05 * size : 0.3;
    const double low = scale * arbitrary.between(-1, 0.2);
    const double kind = arbitrary.between(0, 3);
    // Locked, free (lower above upper), or limited.
    const double high = kind < 1 ? low : kind < 2 ? low - 1 : low + scale * arbitrary.between(0, 1);
    joint.setLimit(axis, btScalar(low), btScalar(high));
  }
}

std::unique_ptr<btTypedConstraint> generic(Arbitrary& arbitrary, const ContactPair& pair,
                                           const Frames& frames) {
  auto joint = std::make_unique<btGeneric6DofConstraint>(pair.a().body(), pair.b().body(),
                                                         frames.in_a, frames.in_b, true);
  setLimits(arbitrary, pair, *joint);
  for (int axis : {0, 1, 2}) {
    btRotationalLimitMotor& motor = *joint->getRotationalLimitMotor(axis);
    motor.m_enableMotor = arbitrary.between(0, 1) < 0.5;
    motor.m_targetVelocity = btScalar(arbitrary.between(-3, 3));
    motor.m_maxMotorForce = btScalar(10 * arbitraryImpulse(arbitrary, pair) * pair.a().size());
    btTranslationalLimitMotor& along = *joint->getTranslationalLimitMotor();
    along.m_enableMotor[axis] = arbitrary.between(0, 1) < 0.5;
    along.m_targetVelocity[axis] = btScalar(arbitrary.between(-1, 1));
    along.m_maxMotorForce[axis] = btScalar(10 * arbitraryImpulse(arbitrary, pair));
  }
  return joint;
}

std::unique_ptr<btTypedConstraint> genericSpring(Arbitrary& arbitrary, const ContactPair& pair,
                                                 const Frames& frames) {
  auto joint = std::make_unique<btGeneric6DofSpringConstraint>(pair.a().body(), pair.b().body(),
                                                               frames.in_a, frames.in_b, true);
  setLimits(arbitrary, pair, *joint);
  for (int axis = 0; axis < 6; ++axis) {
    const double size = axis < 3 ? 1 : pair.a().size();
    joint->enableSpring(axis, arbitrary.between(0, 1) < 0.5);
    joint->setStiffness(axis, btScalar(500 * arbitraryImpulse(arbitrary, pair) * size));
    joint->setDamping(axis, btScalar(arbitrary.between(0.1, 1)));
  }
  return joint;
}

std::unique_ptr<btTypedConstraint> genericSpring2(Arbitrary& arbitrary, const ContactPair& pair,
                                                  const Frames& frames) {
  auto joint = std::make_unique<btGeneric6DofSpring2Constraint>(pair.a().body(), pair.b().body(),
                                                                frames.in_a, frames.in_b);
  for (int axis = 0; axis < 6; ++axis) {
    const double size = axis < 3 ? 1 : pair.a().size();
    const double range = axis < 3 ? 0.05 * pair.a().size() : 0.3;
    const double low = range * arbitrary.between(-1, 0.2);
    // One element per axis: rows of motor, spring and limit along one axis would be dependent.
    const auto kind = static_cast<int>(arbitrary.between(0, 6));
    joint->setLimit(axis, 0, kind == 0 ? 0 : -1);  // locked or free axis
    if (kind == 1) joint->setLimit(axis, btScalar(low), btScalar(range));
    joint->enableMotor(axis, kind == 2 || kind == 3);
    joint->setServo(axis, kind == 3);
    joint->enableSpring(axis, kind == 4);
    joint->setTargetVelocity(axis, btScalar(arbitrary.between(-2, 2)));
    joint->setServoTarget(axis, btScalar(arbitrary.between(-1, 1) * range));
    joint->setMaxMotorForce(axis, btScalar(10 * arbitraryImpulse(arbitrary, pair) * size));
    joint->setStiffness(axis, btScalar(500 * arbitraryImpulse(arbitrary, pair) * size * size));
    joint->setDamping(axis, btScalar(arbitraryImpulse(arbitrary, pair) * size * size));
  }
  return joint;
}

// Arrays of one row, laid out like those that Bullet's solver passes to getInfo2().
struct alignas(16) JointRow {
  btScalar linear_a[4] = {}, angular_a[4] = {}, linear_b[4] = {}, angular_b[4] = {};
  btScalar error = 0, cfm = 0;
  btScalar lower = -SIMD_INFINITY, upper = SIMD_INFINITY;
};

Vector3r vectorOf(const btScalar* v) { return {v[0], v[1], v[2]}; }

Real bound(btScalar limit) {
  return std::abs(limit) < SIMD_INFINITY
             ? Real(limit)
             : std::copysign(reference::DenseRow::kUnbounded, Real(limit));
}

// Clamps infinite target velocities, set by springs that their force bounds, to a large value.
Real finite(btScalar error) { return std::clamp<Real>(error, -1e6L, 1e6L); }

using MadeJoint = std::unique_ptr<btTypedConstraint>;

/// Makes a joint at the contact of a pair with frames slightly turned and moved apart. Random
/// limits, motors and springs, if it has bounds.
struct JointType {
  const char* name;
  bool has_bounds;
  MadeJoint (*make)(Arbitrary&, const ContactPair&, const Frames&);
};

MadeJoint pointToPoint(Arbitrary&, const ContactPair& pair, const Frames& frames) {
  return std::make_unique<btPoint2PointConstraint>(
      pair.a().body(), pair.b().body(), frames.in_a.getOrigin(), frames.in_b.getOrigin());
}

MadeJoint fixed(Arbitrary&, const ContactPair& pair, const Frames& frames) {
  return std::make_unique<btFixedConstraint>(pair.a().body(), pair.b().body(), frames.in_a,
                                             frames.in_b);
}

MadeJoint gear(Arbitrary& arbitrary, const ContactPair& pair, const Frames&) {
  return std::make_unique<btGearConstraint>(
      pair.a().body(), pair.b().body(), toBt(arbitrary.vector()).normalized(),
      toBt(arbitrary.vector()).normalized(), btScalar(arbitrary.between(0.2, 3)));
}

constexpr JointType kJointTypes[] = {{"PointToPoint", false, pointToPoint},
                                     {"Hinge", true, hinge},
                                     {"Slider", true, slider},
                                     {"ConeTwist", true, coneTwist},
                                     {"Generic6Dof", true, generic},
                                     {"Generic6DofSpring", true, genericSpring},
                                     {"Generic6DofSpring2", true, genericSpring2},
                                     {"Fixed", false, fixed},
                                     {"Gear", false, gear}};

// Rows requested by the joint's getInfo2() at the start of a step with these settings. Bullet's
// softness of a joint is a multiple of the row's response.
Rows jointRows(btTypedConstraint& joint, const std::vector<reference::DenseBody>& bodies,
               const btContactSolverInfo& info) {
  joint.buildJacobian();
  btTypedConstraint::btConstraintInfo1 size{};
  joint.getInfo1(&size);
  std::vector<JointRow> asked(size.m_numConstraintRows);
  if (asked.empty()) return {};
  asked[0].cfm = info.m_globalCfm;
  btTypedConstraint::btConstraintInfo2 info2{};
  info2.fps = 1 / info.m_timeStep;
  info2.erp = info.m_erp;
  info2.m_J1linearAxis = asked[0].linear_a;
  info2.m_J1angularAxis = asked[0].angular_a;
  info2.m_J2linearAxis = asked[0].linear_b;
  info2.m_J2angularAxis = asked[0].angular_b;
  info2.rowskip = sizeof(JointRow) / sizeof(btScalar);
  info2.m_constraintError = &asked[0].error;
  info2.cfm = &asked[0].cfm;
  info2.m_lowerLimit = &asked[0].lower;
  info2.m_upperLimit = &asked[0].upper;
  info2.m_damping = info.m_damping;
  info2.m_numIterations = info.m_numIterations;
  joint.getInfo2(&info2);

  Rows rows;
  for (const JointRow& r : asked) {
    reference::DenseRow row;
    row.body_b = 1;
    row.jacobian_a << vectorOf(r.angular_a), vectorOf(r.linear_a);
    row.jacobian_b << vectorOf(r.angular_b), vectorOf(r.linear_b);
    row.lower = bound(r.lower);
    row.upper = bound(r.upper);
    // Damping below 1 keeps a part of the velocity.
    Real free = row.jacobian_a.dot(bodies[0].free_velocity);
    if (!bodies[1].fixed) free += row.jacobian_b.dot(bodies[1].free_velocity);
    row.target = finite(r.error) + (1 - Real(info2.m_damping)) * free;
    row.softness = r.cfm * reference::response(bodies, row, row);
    rows.push_back(row);
  }
  return rows;
}

constexpr int kJointsEach = 150;

bool hasSoftRow(const Rows& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.softness != 0; });
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
  for (const JointType& type : kJointTypes) {
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
      const auto joint = type.make(arbitrary, pair, arbitraryFrames(arbitrary, pair));
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
    EXPECT_LT(worst, kTolerance) << type.name;
    EXPECT_LT(worst_feedback, kFeedbackTolerance) << type.name;
    EXPECT_GT(solved, kJointsEach / 4) << type.name;
    EXPECT_GT(at_bounds, type.has_bounds ? 10 : -1) << type.name;
  }
}

}  // namespace
}  // namespace ambient::test
