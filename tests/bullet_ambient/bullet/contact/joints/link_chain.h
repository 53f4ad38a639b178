#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <array>
#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/contact/coupled_body.h"

namespace ambient::test {

/// A btMultiBody chain: base and three links, revolute, spherical and prismatic joint. The
/// reference has four bodies with joint rows.
class LinkChain {
 public:
  static constexpr int kBodies = 4;  ///< body 0 is the base, body i + 1 link i

  /// Masses 0.3 to 3 kg, sizes about 0.3 m, random pose and velocity.
  static LinkChain random(Arbitrary& arbitrary, bool has_fixed_base);

  btMultiBody& multibody() const { return *multibody_; }
  btMultiBodyLinkCollider& collider(int body) const { return *colliders_[body]; }
  Vector3r centre(int body) const { return frames_[body].centre; }
  bool isFixed(int body) const { return body == 0 && multibody_->hasFixedBase(); }

  /// Present twist from the rates of the joints; world axes.
  DenseVector6 velocity(int body) const;
  /// Velocity of the base and rates of the joints, in Bullet's order.
  using Rates = std::array<btScalar, 11>;
  Rates rates() const;
  void setRates(const Rates& rates) const;
  std::vector<reference::DenseBody> dense() const;
  /// Rows of the joints. The base is body `first` of the reference.
  std::vector<reference::DenseRow> jointRows(int first) const;
  /// Largest error of the twists, defined by CoupledBody::error. `before`: twists before the step.
  double error(const std::vector<DenseVector6>& expected, int first,
               const std::array<DenseVector6, kBodies>& before) const;
  std::array<DenseVector6, kBodies> velocities() const;

 private:
  enum class Joint { kRevolute, kSpherical, kPrismatic };
  struct Frame {
    Matrix3r rotation;  // to world axes
    Vector3r centre, pivot;
    DenseMatrix6 inertia;
  };

  void addLink(Arbitrary& arbitrary, int link, Joint joint);

  static constexpr Joint kJoints[] = {Joint::kRevolute, Joint::kSpherical, Joint::kPrismatic};
  static constexpr double kSize = 0.3;
  std::unique_ptr<btMultiBody> multibody_;
  std::array<std::unique_ptr<btMultiBodyLinkCollider>, kBodies> colliders_;
  std::array<Frame, kBodies> frames_;
};

}  // namespace ambient::test
