#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <memory>
#include <string>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"

namespace ambient::test {

enum class JointType {
  kPointToPoint,
  kHinge,
  kSlider,
  kConeTwist,
  kGeneric6Dof,
  kGeneric6DofSpring,
  kGeneric6DofSpring2,
  kFixed,
  kGear
};
constexpr JointType kJointTypes[] = {
    JointType::kPointToPoint,       JointType::kHinge,       JointType::kSlider,
    JointType::kConeTwist,          JointType::kGeneric6Dof, JointType::kGeneric6DofSpring,
    JointType::kGeneric6DofSpring2, JointType::kFixed,       JointType::kGear};
std::string nameOf(JointType type);

/// A joint at the contact of a pair, whose frames are turned and moved apart a little. With limits,
/// motors and springs of arbitrary size, where the type has any.
std::unique_ptr<btTypedConstraint> arbitraryJoint(Arbitrary& arbitrary, JointType type,
                                                  const ContactPair& pair);

/// The rows that the joint itself asks for (getInfo2), as a step with these settings begins.
/// Bullet's softness of a joint is a multiple of the response of the row.
Rows jointRows(btTypedConstraint& joint, const std::vector<reference::DenseBody>& bodies,
               const btContactSolverInfo& info);

}  // namespace ambient::test
