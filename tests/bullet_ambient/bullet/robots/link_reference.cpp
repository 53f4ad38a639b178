#include "tests/bullet_ambient/bullet/robots/link_reference.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/members/tree_state.h"

namespace ambient::test {
namespace {

using DenseVector3 = Eigen::Matrix<Real, 3, 1>;
using DenseMatrix3 = Eigen::Matrix<Real, 3, 3>;

DenseVector3 real(const btVector3& v) { return {Real(v.x()), Real(v.y()), Real(v.z())}; }

btTransform poseOf(const btMultiBody& body, int link) {
  return link < 0 ? body.getBaseWorldTransform() : body.getLink(link).m_cachedWorldTransform;
}
DenseMatrix3 axesOf(const btMultiBody& body, int link) {
  return toQuaternion(poseOf(body, link).getRotation()).toRotationMatrix().cast<Real>();
}
DenseVector3 placeOf(const btMultiBody& body, int link) {
  return real(poseOf(body, link).getOrigin());
}

reference::DenseBody bodyOf(const btMultiBody& body, int link, const Fluid& fluid) {
  reference::DenseMatrix6 K = reference::DenseMatrix6::Zero();
  K.topLeftCorner<3, 3>() =
      real(link < 0 ? body.getBaseInertia() : body.getLinkInertia(link)).asDiagonal();
  K.bottomRightCorner<3, 3>() =
      DenseMatrix3::Identity() * Real(link < 0 ? body.getBaseMass() : body.getLinkMass(link));
  if (fluid.find(body, link)) K = fluid.find(body, link)->inertia().cast<Real>();
  return {link < 0 && body.hasFixedBase(), reference::turned(K, axesOf(body, link)),
          DenseVector6::Zero()};
}

// Two unit directions across an axis.
std::vector<DenseVector3> across(const DenseVector3& axis) {
  const DenseVector3 one = axis.unitOrthogonal();
  return {one, axis.cross(one)};
}

struct JointFrame {
  DenseVector3 axis, pivot_from_link, pivot_from_parent, link_from_parent;
};

JointFrame frameOf(const btMultiBody& body, int link) {
  const btMultibodyLink& joint = body.getLink(link);
  const DenseMatrix3 R = axesOf(body, link);
  const bool slides = joint.m_jointType == btMultibodyLink::ePrismatic;
  const DenseVector3 axis = real(slides ? joint.m_axes[0].m_bottomVec : joint.m_axes[0].m_topVec);
  JointFrame frame;
  frame.axis = (R * axis).normalized();
  frame.link_from_parent = placeOf(body, link) - placeOf(body, joint.m_parent);
  frame.pivot_from_link = -(R * real(joint.m_dVector));
  frame.pivot_from_parent = frame.link_from_parent + frame.pivot_from_link;
  return frame;
}

// Completes a row between a link and its parent.
reference::DenseRow atJoint(const btMultiBody& body, int link, reference::DenseRow row) {
  row.body_a = link + 1;
  row.body_b = body.getLink(link).m_parent + 1;
  return row;
}

std::vector<reference::DenseRow> rowsOfJoint(const btMultiBody& body, int link) {
  const JointFrame frame = frameOf(body, link);
  const std::vector<DenseVector3> all{DenseVector3::UnitX(), DenseVector3::UnitY(),
                                      DenseVector3::UnitZ()};
  std::vector<DenseVector3> held_at_pivot, held_at_link, held_turns;
  switch (body.getLink(link).m_jointType) {
    case btMultibodyLink::eRevolute:
      held_at_pivot = all;
      held_turns = across(frame.axis);
      break;
    case btMultibodyLink::ePrismatic:
      held_at_link = across(frame.axis);
      held_turns = all;
      break;
    case btMultibodyLink::eSpherical:
      held_at_pivot = all;
      break;
    case btMultibodyLink::ePlanar:
      held_at_link = {frame.axis};
      held_turns = across(frame.axis);
      break;
    default:
      held_at_pivot = held_turns = all;
  }
  std::vector<reference::DenseRow> rows;
  for (const DenseVector3& d : held_at_pivot)
    rows.push_back(reference::pointRow(d, frame.pivot_from_link, frame.pivot_from_parent));
  for (const DenseVector3& d : held_at_link)
    rows.push_back(reference::pointRow(d, DenseVector3::Zero(), frame.link_from_parent));
  for (const DenseVector3& d : held_turns) rows.push_back(reference::spinRow(d));
  for (reference::DenseRow& row : rows) row = atJoint(body, link, row);
  return rows;
}

}  // namespace

std::vector<DenseVector6> twistsOf(const btMultiBody& body) {
  const int count = body.getNumLinks() + 1;
  std::vector<btVector3> spins(count), velocities(count);
  body.compTreeLinkVelocities(spins.data(), velocities.data());
  std::vector<DenseVector6> twists(count);
  for (int i = 0; i < count; ++i) {
    const DenseMatrix3 R = axesOf(body, i - 1);
    twists[i] << R * real(spins[i]), R * real(velocities[i]);
  }
  return twists;
}

DenseRobot denseRobot(const btMultiBody& body, const Fluid& fluid) {
  DenseRobot robot;
  const std::vector<DenseVector6> twists = twistsOf(body);
  for (int link = -1; link < body.getNumLinks(); ++link) {
    robot.bodies.push_back(bodyOf(body, link, fluid));
    robot.bodies.back().free_velocity = twists[link + 1];
    if (link < 0) continue;
    for (const reference::DenseRow& row : rowsOfJoint(body, link)) robot.rows.push_back(row);
  }
  robot.bodies.emplace_back();
  robot.bodies.back().fixed = true;
  return robot;
}

reference::DenseRow groundRow(const btMultiBody& body, int link, const btVector3& point,
                              const btVector3& direction) {
  reference::DenseRow row =
      reference::pointRow(real(direction), real(point) - placeOf(body, link), DenseVector3::Zero());
  row.body_a = link + 1;
  row.body_b = body.getNumLinks() + 1;
  return row;
}

reference::DenseRow rateRow(const btMultiBody& body, int link) {
  const JointFrame frame = frameOf(body, link);
  const bool slides = body.getLink(link).m_jointType == btMultibodyLink::ePrismatic;
  return atJoint(body, link,
                 slides
                     ? reference::pointRow(frame.axis, DenseVector3::Zero(), frame.link_from_parent)
                     : reference::spinRow(frame.axis));
}

reference::DenseRow turnRow(const btMultiBody& body, int link, int axis) {
  return atJoint(body, link, reference::spinRow(axesOf(body, link).col(axis)));
}

void driveBase(const btMultiBody& body, DenseRobot& robot) {
  for (int axis = 0; axis < 3; ++axis) {
    btVector3 direction(0, 0, 0);
    direction[axis] = 1;
    reference::DenseRow slide = groundRow(body, -1, body.getBasePos(), direction);
    slide.target = robot.bodies[0].free_velocity[3 + axis];
    reference::DenseRow turn = reference::spinRow(DenseVector3::Unit(axis));
    turn.body_b = robot.ground();
    turn.target = robot.bodies[0].free_velocity[axis];
    robot.rows.push_back(slide);
    robot.rows.push_back(turn);
  }
}

double twistError(const btMultiBody& now, const std::vector<DenseVector6>& expected,
                  const std::vector<DenseVector6>& before) {
  DenseVector6 units = DenseVector6::Ones();
  units.head<3>().setConstant(0.15L);
  const std::vector<DenseVector6> twists = twistsOf(now);
  Real difference = 0, scale = 0;
  for (std::size_t i = 0; i < twists.size(); ++i) {
    const auto size = [&units](const DenseVector6& u) { return u.cwiseProduct(units).norm(); };
    difference = std::max(difference, size(twists[i] - expected[i]));
    scale = std::max({scale, size(expected[i]), size(before[i])});
  }
  return static_cast<double>(difference / scale);
}

namespace {

void addPoint(const btMultiBody& body, const btManifoldPoint& point, bool is_first, int link,
              const DenseVector6& before, const ContactLaw& law, DenseRobot& robot) {
  if (point.getDistance() > 0) return;  // gap too wide for so short a step
  const btVector3 place = is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
  const btScalar sign = bt(is_first ? 1 : -1);
  reference::DenseRow row = groundRow(body, link, place, sign * point.m_normalWorldOnB);
  row.lower = 0;
  row.target = std::max<Real>(0, -law.restitution * row.jacobian_a.dot(before));
  const int normal_row = static_cast<int>(robot.rows.size());
  robot.rows.push_back(row);
  const btVector3 directions[] = {point.m_lateralFrictionDir1, point.m_lateralFrictionDir2};
  for (int i = 0; i < law.friction_directions; ++i) {
    reference::DenseRow friction = groundRow(body, link, place, sign * directions[i]);
    friction.normal_row = normal_row;
    friction.friction = law.friction;
    robot.rows.push_back(friction);
  }
}

}  // namespace

btCollisionObject& addFloor(RobotWorld& world, const btMultiBody& body, int link,
                            const btVector3& normal, double restitution) {
  const btVector3 centre =
      link < 0 ? body.getBasePos() : body.getLink(link).m_cachedWorldTransform.getOrigin();
  const btScalar half = bt(0.04), overlap = bt(1e-6);
  const btTransform place(shortestArcQuat(btVector3(0, 0, 1), normal),
                          centre - normal * (bt(kSphereRadius) + half - overlap));
  auto box = std::make_unique<btBoxShape>(btVector3(half, half, half));
  box->setMargin(bt(1e-4));
  btCollisionObject& floor = world.addFixed(std::move(box), place);
  floor.setRestitution(bt(restitution));
  return floor;
}

void addContacts(RobotWorld& world, const btMultiBody& body,
                 const std::vector<DenseVector6>& before, const ContactLaw& law,
                 DenseRobot& robot) {
  for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(i);
    const auto* a = btMultiBodyLinkCollider::upcast(manifold.getBody0());
    const auto* b = btMultiBodyLinkCollider::upcast(manifold.getBody1());
    const int link = (a ? a : b)->m_link;
    for (int k = 0; k < manifold.getNumContacts(); ++k)
      addPoint(body, manifold.getContactPoint(k), a != nullptr, link, before[link + 1], law, robot);
  }
}

}  // namespace ambient::test
