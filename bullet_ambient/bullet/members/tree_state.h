#pragma once

#include <LinearMath/btTransform.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/motion/links/link_tree.h"

class btMultiBody;

AMBIENT_BEGIN

/// Links and joints of a btMultiBody, link 0 its base; without fluid.
LinkTree makeLinkTree(const btMultiBody& multi_body);

/// Whether it has these links and joints. Another one at its address rarely has. Masses may differ.
bool hasLinksOf(const btMultiBody& multi_body, const LinkTree& tree) noexcept;

/// Takes what may change between steps: masses, damping, applied forces and torques, with the
/// weight, and what is kinematic. Allocates nothing.
void readLinks(const btMultiBody& multi_body, LinkTree& tree) noexcept;

/// Allocates nothing if `pose` has the size.
void readPose(const btMultiBody& multi_body, TreePose& pose) noexcept;

void readVelocity(const btMultiBody& multi_body, CoordinatesOut u) noexcept;
/// Reads the change of the velocity by rows in this substep.
void readChange(const btMultiBody& multi_body, CoordinatesOut change) noexcept;

/// Within the limit of the btMultiBody's coordinate velocity.
void writeVelocity(btMultiBody& multi_body, const CoordinatesIn& u) noexcept;
void addVelocity(btMultiBody& multi_body, const CoordinatesIn& change) noexcept;
void addChange(btMultiBody& multi_body, const CoordinatesIn& change) noexcept;
void clearChange(btMultiBody& multi_body) noexcept;

/// Whether Bullet takes the multibody for asleep: one link that sleeps is enough.
bool isAsleep(const btMultiBody& multi_body) noexcept;

/// Pose of a link in W, -1: the base, by the positions of the joints now. Cost: its ancestors.
btTransform linkTransform(const btMultiBody& multi_body, int link);

AMBIENT_END
