#pragma once

#include <LinearMath/btTransform.h>
#include <LinearMath/btVector3.h>

#include <optional>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/attach_body.h"
#include "bullet_ambient/immersed/attach_def.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;

AMBIENT_BEGIN

/// A link that fixed joints hold to another one, and its pose in the frame of that one's centre of
/// mass.
struct FixedLink {
  int link;  ///< Bullet's number; -1: the base
  btTransform pose;
};

/// Finds the link with a mass that feels what acts on a link: itself, or if it has no mass the
/// nearest one that fixed joints hold to it, parents before children. A fixed base counts as such a
/// link. `pose`: that of the given link in the frame of the one found. None: there is no such link.
std::optional<FixedLink> carrierOf(const btMultiBody& multi_body, int link);

/// Returns the links without mass whose carrier is a link with a mass, in ascending order.
std::vector<FixedLink> carriedBy(const btMultiBody& multi_body, int carrier);

struct AmbientLink;
struct AmbientTree;
class AmbientBodies;

/// A link of a btMultiBody by Bullet's number; -1: the base.
struct LinkOf {
  btMultiBody& multi_body;
  int link;
};

/// Inverts a mass and moments as btRigidBody::setMassProps() does; 0 stays 0.
InverseMass inverseOf(btScalar mass, const btVector3& inertia) noexcept;
/// Returns the inverse mass of a link; 0: it has no mass.
InverseMass inverseMassOf(const btMultiBody& multi_body, int link) noexcept;

/// Sets the present pose of a link. Leaves its velocity.
void readLinkPose(const btMultiBody& multi_body, AmbientLink& link) noexcept;

/// Implements Fluid::add() for a link, except the warning about light links. A link without mass is
/// carried by one at a fixed joint, carrierOf(): then that one is added. @throws
/// std::invalid_argument as Fluid::add()
AmbientBody& attachLink(AmbientBodies& bodies, btMultiBodyDynamicsWorld& world, const LinkOf& link,
                        AttachDef def);

/// Wakes a multibody and its colliders, like btCollisionObject::activate() for bodies.
void wake(btMultiBody& multi_body) noexcept;

/// Returns the masses of a new member by which it rises: it is much lighter than what it displaces,
/// and there is gravity; else none. A robot is judged as a whole, when the link comes that makes it
/// that light; one on a fixed base never. `tree`: that of the link; null: the member is a body.
/// `gravity`: of the world, for bodies that are not in it yet [m/s^2].
std::optional<DisplacedMass> risingMass(const AmbientBody& ambient, const AmbientTree* tree,
                                        const btVector3& gravity);

AMBIENT_END
