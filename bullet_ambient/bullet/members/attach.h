#pragma once

#include <LinearMath/btTransform.h>

#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/warnings.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;
class btRigidBody;

AMBIENT_BEGIN

class AmbientBodies;
class AmbientTrees;
struct AmbientLink;

/// Makes the models of a body or link again, in the medium around it now. If this throws, nothing
/// has changed.
/// @throws std::invalid_argument as refreshModels().
void refresh(AmbientBody& ambient, const InverseMass& mass, const MotionView& now,
             AmbientBodies& bodies);

/// Checks the flight settings and enumerators of a definition; refresh() checks shape and medium.
/// @throws std::invalid_argument that begins with `who`.
void checkDef(const std::string& who, const AttachDef& def);

/// Checks the water in a hold [m^3].
/// @throws std::invalid_argument that begins with `who`.
void checkWater(const std::string& who, int hold, double volume, double capacity);

/// Implements Fluid::add() for a body, except the warning about light bodies.
/// @throws std::invalid_argument as Fluid::add().
AmbientBody& attachBody(AmbientBodies& bodies, btRigidBody& body, AttachDef def);

/// Inverts a mass and moments as btRigidBody::setMassProps() does; 0 stays 0.
InverseMass inverseOf(btScalar mass, const btVector3& inertia) noexcept;
/// Returns the inverse mass of a link; 0: it has no mass.
InverseMass inverseMassOf(const btMultiBody& multi_body, int link) noexcept;

/// Sets the present pose of a link. Leaves its velocity.
void readLinkPose(const btMultiBody& multi_body, AmbientLink& link) noexcept;

/// Implements Fluid::add() for a link, except the warning about light links. A link without mass is
/// carried by one at a fixed joint, carrierOf(): then that one is added. @throws
/// std::invalid_argument as Fluid::add()
AmbientBody& attachLink(AmbientBodies& bodies, btMultiBodyDynamicsWorld& world,
                        btMultiBody& multi_body, int link, AttachDef def);

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

/// Computes both masses in the medium around the body now. A body in a region with a water surface
/// counts as floating. @pre the body was dynamic when its models were made
DisplacedMass displacedMass(const AmbientBody& ambient);

/// Returns the masses of a new body or link by which it rises: it is much lighter than what it
/// displaces, and there is gravity; else none. A robot is judged as a whole, when the link comes
/// that makes it that light; one on a fixed base never. `trees`: of the fluid. `gravity`: of the
/// world, for bodies that are not in it yet [m/s^2].
std::optional<DisplacedMass> risingMass(const AmbientBody& ambient, const AmbientTrees& trees,
                                        const btVector3& gravity);

/// Warns once of bodies much lighter than the medium that they displace. `def`, `mass`: of the
/// lightest body in proportion; `count`: number of such bodies.
void warnOfLightBody(Warnings& warnings, const AttachDef& def, const DisplacedMass& mass,
                     int count);

/// Wakes a multibody and its colliders, like btCollisionObject::activate() for bodies.
void wake(btMultiBody& multi_body) noexcept;
/// Wakes a body, or the multibody of a link. @pre it is alive
void wake(const AmbientBody& ambient) noexcept;

AMBIENT_END
