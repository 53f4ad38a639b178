#include "tests/bullet_ambient/bullet/contact/joints/joint_rows.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>

namespace ambient::test {
namespace {

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

}  // namespace

std::string nameOf(JointType type) {
  constexpr const char* kNames[] = {"PointToPoint",       "Hinge",       "Slider",
                                    "ConeTwist",          "Generic6Dof", "Generic6DofSpring",
                                    "Generic6DofSpring2", "Fixed",       "Gear"};
  return kNames[static_cast<int>(type)];
}

std::unique_ptr<btTypedConstraint> arbitraryJoint(Arbitrary& arbitrary, JointType type,
                                                  const ContactPair& pair) {
  const Frames frames = arbitraryFrames(arbitrary, pair);
  btRigidBody& a = pair.a().body();
  btRigidBody& b = pair.b().body();
  switch (type) {
    case JointType::kPointToPoint:
      return std::make_unique<btPoint2PointConstraint>(a, b, frames.in_a.getOrigin(),
                                                       frames.in_b.getOrigin());
    case JointType::kHinge:
      return hinge(arbitrary, pair, frames);
    case JointType::kSlider:
      return slider(arbitrary, pair, frames);
    case JointType::kConeTwist:
      return coneTwist(arbitrary, pair, frames);
    case JointType::kGeneric6Dof:
      return generic(arbitrary, pair, frames);
    case JointType::kGeneric6DofSpring:
      return genericSpring(arbitrary, pair, frames);
    case JointType::kGeneric6DofSpring2:
      return genericSpring2(arbitrary, pair, frames);
    case JointType::kFixed:
      return std::make_unique<btFixedConstraint>(a, b, frames.in_a, frames.in_b);
    case JointType::kGear:
      return std::make_unique<btGearConstraint>(a, b, toBt(arbitrary.vector()).normalized(),
                                                toBt(arbitrary.vector()).normalized(),
                                                btScalar(arbitrary.between(0.2, 3)));
  }
  return nullptr;
}

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

}  // namespace ambient::test
