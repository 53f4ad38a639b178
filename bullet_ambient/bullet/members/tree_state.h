#pragma once

#include <LinearMath/btTransform.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/motion/links/link_tree.h"

class btMultiBody;

AMBIENT_BEGIN

// Bullet numbers btRigidBody and not btMultiBody. The number stands, as an int, where
// finalizeMultiDof() makes room for changes of position, behind velocities and joint inertias.
// finalizeMultiDof() of a new btMultiBody zeroes this room, so that a new one at an old address has
// no number. Nothing but Bullet's RK4 integration reads or writes there.

/// Reads the number that a btMultiBody was given; 0: none. @pre it is alive and finalized
int instanceNumber(const btMultiBody& multi_body) noexcept;

/// Writes a number that RK4 integration has overwritten.
void setInstanceNumber(btMultiBody& multi_body, int number) noexcept;

/// Returns the number of a btMultiBody; gives it a new, unique one if it has none.
int giveInstanceNumber(btMultiBody& multi_body) noexcept;

/// Copies links and joints of a btMultiBody to a LinkTree without fluid; link 0 is the base.
LinkTree makeLinkTree(const btMultiBody& multi_body);

/// True if a btMultiBody has the links and joints of a tree; masses may differ. Detects most cases
/// of another multibody at the same address.
bool hasLinksOf(const btMultiBody& multi_body, const LinkTree& tree) noexcept;

/// Copies what may change between steps: masses, damping, applied forces and torques including
/// weight, and which links are kinematic. Allocates nothing.
void readLinks(const btMultiBody& multi_body, LinkTree& tree) noexcept;

/// Copies the pose. Allocates nothing if `pose` has the right size.
void readPose(const btMultiBody& multi_body, TreePose& pose) noexcept;

void readVelocity(const btMultiBody& multi_body, CoordinatesOut u) noexcept;
/// Reads the change of the velocity by rows in this substep.
void readChange(const btMultiBody& multi_body, CoordinatesOut change) noexcept;

/// Computes the velocity that the multibody has once Bullet adds the change by rows, which it then
/// moves the multibody by.
void readChangedVelocity(const btMultiBody& multi_body, CoordinatesOut u) noexcept;

/// Sets the velocity, each coordinate limited by btMultiBody::getMaxCoordinateVelocity().
void writeVelocity(btMultiBody& multi_body, const CoordinatesIn& u) noexcept;
void addVelocity(btMultiBody& multi_body, const CoordinatesIn& change) noexcept;
void addChange(btMultiBody& multi_body, const CoordinatesIn& change) noexcept;
void clearChange(btMultiBody& multi_body) noexcept;

/// Returns the collider of a link; -1: of the base. Null: it has none. `Body`: btMultiBody, const
/// or not.
template <class Body>
auto* colliderOf(Body& multi_body, int link) noexcept {
  return link < 0 ? multi_body.getBaseCollider() : multi_body.getLinkCollider(link);
}

/// True if Bullet treats the multibody as asleep: at least one collider sleeps.
bool isAsleep(const btMultiBody& multi_body) noexcept;

/// Computes the pose of a link in W from the present joint positions; -1: the base. Cost: O(number
/// of ancestors).
btTransform linkTransform(const btMultiBody& multi_body, int link);

AMBIENT_END
