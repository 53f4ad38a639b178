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

/// Makes a joint at the contact of a pair with frames slightly turned and moved apart. Random
/// limits, motors and springs, if the type has any.
std::unique_ptr<btTypedConstraint> arbitraryJoint(Arbitrary& arbitrary, JointType type,
                                                  const ContactPair& pair);

/// Rows requested by the joint's getInfo2() at the start of a step with these settings. Bullet's
/// softness of a joint is a multiple of the row's response.
Rows jointRows(btTypedConstraint& joint, const std::vector<reference::DenseBody>& bodies,
               const btContactSolverInfo& info);

}  // namespace ambient::test
