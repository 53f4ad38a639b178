#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/motion/links/link_flight.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {

/// A tree of links with its models, pose and velocity.
struct TestTree {
  LinkTree tree;
  std::vector<std::unique_ptr<const BodyModel>> models;
  TreePose pose;
  Coordinates u;

  /// Puts link l into a fluid.
  void setModel(int l, BodyModel model) {
    models.push_back(std::make_unique<const BodyModel>(std::move(model)));
    tree.links[l].model = models.back().get();
  }
  /// Advances by steps of the flight; returns the result of the last one.
  LinkFlightResult fly(LinkFlight& flight, double step, int steps = 1,
                       const LinkFlightSettings& settings = {}) {
    LinkFlightResult result;
    for (int i = 0; i < steps; ++i) {
      result = flight.fly(pose, u, step, settings);
      pose = flight.endPose();
      u = flight.endVelocity();
    }
    return result;
  }
};

struct TreeShape {
  int links = 3;                ///< besides the base
  bool has_all_joints = false;  ///< false: revolute joints only
  bool is_branched = false;     ///< false: a chain
  double added_mass = 5;        ///< largest over dry, roughly; 0: no fluid
  double speed = 1;             ///< joints [2 rad/s] and base [m/s]
};

/// Random added mass, all 36 entries coupled, for a link of this mass and size.
inline Matrix6 coupledAddedMass(Arbitrary& arbitrary, double mass, double size) {
  Vector6 scale;
  scale << size, size, size, 1, 1, 1;
  return mass / 6 * (scale.asDiagonal() * arbitrary.positiveDefinite() * scale.asDiagonal());
}

inline Joint randomJoint(Arbitrary& arbitrary, JointKind kind) {
  Joint joint;
  joint.kind = kind;
  joint.zero_axes = arbitrary.rotation().transpose();
  joint.parent_to_pivot = Vector3(0.15, 0, 0) + arbitrary.vector(0.03);
  const Vector3 d = Vector3(0.15, 0, 0) + arbitrary.vector(0.03);
  const Vector3 n = arbitrary.vector().normalized();
  joint.pivot_to_link = d;
  switch (kind) {
    case JointKind::kFixed:
      break;
    case JointKind::kRevolute:
      joint.axes[0] = stack(n, n.cross(d));
      break;
    case JointKind::kPrismatic:
      joint.axes[0] = stack(Vector3::Zero(), n);
      break;
    case JointKind::kSpherical:
      for (int i = 0; i < 3; ++i)
        joint.axes[i] = stack(Vector3::Unit(i), Vector3::Unit(i).cross(d));
      break;
    case JointKind::kPlanar: {  // Bullet's planar axes are not of length 1
      const Vector3 first = n.cross(Vector3::UnitX());
      joint.pivot_to_link.setZero();
      joint.axes = {stack(n, Vector3::Zero()), stack(Vector3::Zero(), first),
                    stack(Vector3::Zero(), first.cross(n))};
      break;
    }
  }
  return joint;
}

inline JointPosition randomPosition(Arbitrary& arbitrary, JointKind kind) {
  if (kind == JointKind::kSpherical) {
    const Quaternion q(arbitrary.rotation());
    return {q.x(), q.y(), q.z(), q.w()};
  }
  const bool is_turn = kind == JointKind::kRevolute || kind == JointKind::kPlanar;
  return {arbitrary.between(-1, 1) * (is_turn ? 0.7 : 0.1), arbitrary.between(-0.1, 0.1),
          arbitrary.between(-0.1, 0.1), 0};
}

inline Link randomLink(Arbitrary& arbitrary, const TreeShape& shape, int l) {
  Link link;
  const double size = l == 0 ? 0.025 : 0.006;
  link.mass = arbitrary.between(0.4, 1);
  link.inertia = size * Vector3(arbitrary.between(0.8, 1.2), arbitrary.between(0.8, 1.2),
                                arbitrary.between(0.8, 1.2));
  if (l == 0) return link;
  link.parent = shape.is_branched ? static_cast<int>(arbitrary.between(0, l)) : l - 1;
  const int kind = (l - 1) % 5;
  link.joint = randomJoint(
      arbitrary, shape.has_all_joints ? static_cast<JointKind>(kind) : JointKind::kRevolute);
  return link;
}

inline TestTree randomTree(Arbitrary& arbitrary, const TreeShape& shape) {
  TestTree result;
  result.pose.orientation = Quaternion(arbitrary.rotation());
  result.pose.position = arbitrary.vector();
  for (int l = 0; l <= shape.links; ++l) {
    result.tree.links.push_back(randomLink(arbitrary, shape, l));
    const Link& link = result.tree.links.back();
    result.pose.joints.push_back(randomPosition(arbitrary, link.joint.kind));
    if (shape.added_mass == 0) continue;
    FluidBody body = shapeWithoutFaces(
        shape.added_mass * coupledAddedMass(arbitrary, link.mass, 0.2), 0.7 * link.mass);
    body.centre_of_volume = arbitrary.vector(0.02);
    result.setModel(l, modelOf({body, {link.mass, link.inertia.asDiagonal()}}));
  }
  result.u.resize(coordinateCount(result.tree));
  for (double& u : result.u) u = shape.speed * arbitrary.between(-2, 2);
  result.u.segment<3>(3) *= 0.5;
  return result;
}

/// Sets random forces, joint forces, flow, flow acceleration and gravity.
inline void pushAround(Arbitrary& arbitrary, LinkTree& tree) {
  const Vector3 gravity = arbitrary.vector(5);
  for (Link& link : tree.links) {
    link.surroundings.gravity = gravity;
    link.surroundings.applied = {arbitrary.vector(), arbitrary.vector()};
    link.surroundings.ambient_velocity = arbitrary.vector();
    link.surroundings.ambient_acceleration = arbitrary.vector();
    for (double& force : link.joint_force) force = arbitrary.between(-1, 1);
  }
}

}  // namespace ambient::test
