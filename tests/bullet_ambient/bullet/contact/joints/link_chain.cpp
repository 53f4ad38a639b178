#include "tests/bullet_ambient/bullet/contact/joints/link_chain.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ambient::test {
namespace {

using Quaternionr = Eigen::Quaternion<Real>;

btQuaternion arbitraryRotation(Arbitrary& arbitrary) {
  const Quaternion q(arbitrary.rotation());
  return {btScalar(q.x()), btScalar(q.y()), btScalar(q.z()), btScalar(q.w())};
}

Matrix3r exactRotation(const btQuaternion& q) {
  return Quaternionr(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
}

btScalar arbitraryMass(Arbitrary& arbitrary) {
  return btScalar(std::pow(10, arbitrary.between(-0.5, 0.5)));
}

btVector3 arbitraryMoments(Arbitrary& arbitrary, btScalar mass, double size) {
  return mass * toBt(size * size *
                     Vector3{arbitrary.between(0.3, 1), arbitrary.between(0.3, 1),
                             arbitrary.between(0.3, 1)});
}

DenseMatrix6 inertiaOf(btScalar mass, const btVector3& moments, const Matrix3r& rotation) {
  DenseMatrix6 K = DenseMatrix6::Zero();
  K.topLeftCorner<3, 3>() = exact(moments).asDiagonal();
  K.bottomRightCorner<3, 3>() = Matrix3r::Identity() * mass;
  return reference::turned(K, rotation);
}

}  // namespace

LinkChain LinkChain::random(Arbitrary& arbitrary, bool has_fixed_base) {
  LinkChain chain;
  const btScalar mass = arbitraryMass(arbitrary);
  const btVector3 moments = arbitraryMoments(arbitrary, mass, kSize);
  chain.multibody_ = std::make_unique<btMultiBody>(3, mass, moments, has_fixed_base, false);
  btMultiBody& multibody = *chain.multibody_;
  const btQuaternion to_base = arbitraryRotation(arbitrary);
  multibody.setBasePos(toBt(arbitrary.vector()));
  multibody.setWorldToBaseRot(to_base);
  multibody.setLinearDamping(0);
  multibody.setAngularDamping(0);
  multibody.setMaxCoordinateVelocity(btScalar(1e6));  // light links exceed Bullet's 100 rad/s
  const Matrix3r rotation = exactRotation(to_base).transpose();
  chain.frames_[0] = {rotation, exact(multibody.getBasePos()), Vector3r::Zero(),
                      inertiaOf(mass, moments, rotation)};
  for (int link = 0; link < 3; ++link) chain.addLink(arbitrary, link, kJoints[link]);
  multibody.finalizeMultiDof();
  for (int body = 0; body < kBodies; ++body)
    chain.colliders_[body] = std::make_unique<btMultiBodyLinkCollider>(&multibody, body - 1);

  if (!has_fixed_base) {
    multibody.setBaseVel(toBt(arbitrary.vector()));
    multibody.setBaseOmega(toBt(arbitrary.vector(1 / kSize)));
  }
  btScalar rates[3];
  for (int link = 0; link < 3; ++link) {
    const double scale = kJoints[link] == Joint::kPrismatic ? 1 : 1 / kSize;
    for (btScalar& rate : rates) rate = btScalar(scale * arbitrary.between(-1, 1));
    multibody.setJointVelMultiDof(link, rates);
  }
  // Repeats the world's preparation before its solver call; advances no time.
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btScalar> scalars;
  btAlignedObjectArray<btMatrix3x3> matrices;
  multibody.forwardKinematics(rotations, vectors);
  multibody.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scalars, vectors, matrices,
                                                                 false, false, false);
  return chain;
}

void LinkChain::addLink(Arbitrary& arbitrary, int link, Joint joint) {
  const btScalar mass = arbitraryMass(arbitrary);
  const btVector3 moments = arbitraryMoments(arbitrary, mass, kSize);
  const btQuaternion from_parent = arbitraryRotation(arbitrary);
  const btVector3 to_pivot = toBt(arbitrary.vector(kSize / 2));
  const btVector3 to_centre = toBt(arbitrary.vector(kSize / 2));
  const btVector3 axis(0, 0, 1);
  const int parent = link - 1;
  btMultiBody& multibody = *multibody_;
  switch (joint) {
    case Joint::kRevolute:
      multibody.setupRevolute(link, mass, moments, parent, from_parent, axis, to_pivot, to_centre);
      break;
    case Joint::kSpherical:
      multibody.setupSpherical(link, mass, moments, parent, from_parent, to_pivot, to_centre);
      break;
    case Joint::kPrismatic:
      multibody.setupPrismatic(link, mass, moments, parent, from_parent, axis, to_pivot, to_centre,
                               true);
      break;
  }
  const Frame& last = frames_[link];
  Frame& frame = frames_[link + 1];
  frame.rotation = last.rotation * exactRotation(from_parent).transpose();
  frame.pivot = last.centre + last.rotation * exact(to_pivot);
  frame.centre = frame.pivot + frame.rotation * exact(to_centre);
  frame.inertia = inertiaOf(mass, moments, frame.rotation);
}

DenseVector6 LinkChain::velocity(int body) const {
  DenseVector6 u = DenseVector6::Zero();
  if (body == 0) {
    if (!isFixed(0)) u << exact(multibody_->getBaseOmega()), exact(multibody_->getBaseVel());
    return u;
  }
  const DenseVector6 last = velocity(body - 1);
  const Frame& frame = frames_[body];
  const btScalar* rates = multibody_->getJointVelMultiDof(body - 1);
  Vector3r w = last.head<3>(), sliding = Vector3r::Zero();
  switch (kJoints[body - 1]) {
    case Joint::kRevolute:
      w += frame.rotation.col(2) * rates[0];
      break;
    case Joint::kSpherical:
      w += frame.rotation * Vector3r(rates[0], rates[1], rates[2]);
      break;
    case Joint::kPrismatic:
      sliding = frame.rotation.col(2) * rates[0];
      break;
  }
  const Vector3r w_last = last.head<3>();
  u << w, Vector3r(last.tail<3>() + w_last.cross(frame.pivot - frames_[body - 1].centre) +
                   w.cross(frame.centre - frame.pivot) + sliding);
  return u;
}

std::array<DenseVector6, LinkChain::kBodies> LinkChain::velocities() const {
  return {velocity(0), velocity(1), velocity(2), velocity(3)};
}

LinkChain::Rates LinkChain::rates() const {
  Rates rates;
  std::copy_n(multibody_->getVelocityVector(), rates.size(), rates.begin());
  return rates;
}

void LinkChain::setRates(const Rates& rates) const {
  multibody_->setBaseOmega({rates[0], rates[1], rates[2]});
  multibody_->setBaseVel({rates[3], rates[4], rates[5]});
  multibody_->setJointVelMultiDof(0, &rates[6]);
  multibody_->setJointVelMultiDof(1, &rates[7]);
  multibody_->setJointVelMultiDof(2, &rates[10]);
}

std::vector<reference::DenseBody> LinkChain::dense() const {
  std::vector<reference::DenseBody> bodies;
  for (int body = 0; body < kBodies; ++body)
    bodies.push_back({isFixed(body), frames_[body].inertia, velocity(body)});
  return bodies;
}

std::vector<reference::DenseRow> LinkChain::jointRows(int first) const {
  std::vector<reference::DenseRow> rows;
  for (int body = 1; body < kBodies; ++body) {
    const Frame& frame = frames_[body];
    const auto add = [&](reference::DenseRow row) {
      row.body_a = first + body;
      row.body_b = first + body - 1;
      rows.push_back(row);
    };
    for (int axis : {0, 1, 2}) {
      const Vector3r direction = frame.rotation.col(axis);
      const bool is_joint_axis = axis == 2;
      const Joint joint = kJoints[body - 1];
      if (joint != Joint::kPrismatic || !is_joint_axis)
        add(reference::pointRow(direction, frame.pivot - frame.centre,
                                frame.pivot - frames_[body - 1].centre));
      if (joint == Joint::kPrismatic || (joint == Joint::kRevolute && !is_joint_axis))
        add(reference::spinRow(direction));
    }
  }
  return rows;
}

double LinkChain::error(const std::vector<DenseVector6>& expected, int first,
                        const std::array<DenseVector6, kBodies>& before) const {
  DenseVector6 units = DenseVector6::Ones();
  units.head<3>().setConstant(kSize);
  Real difference = 0, scale = 0;
  for (int body = 0; body < kBodies; ++body) {
    const auto length = [&](const DenseVector6& u) { return u.cwiseProduct(units).norm(); };
    difference = std::max(difference, length(velocity(body) - expected[first + body]));
    scale = std::max({scale, length(expected[first + body]), length(before[body])});
  }
  return static_cast<double>(difference / scale);
}

}  // namespace ambient::test
