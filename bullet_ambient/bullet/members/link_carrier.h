#pragma once

#include <LinearMath/btTransform.h>

#include <optional>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"

class btMultiBody;

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

AMBIENT_END
