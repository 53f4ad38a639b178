#pragma once

#include <string>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/attach_def.h"

class btRigidBody;

AMBIENT_BEGIN

struct AmbientBody;
class AmbientBodies;
class Complaints;

/// Body and displaced medium.
struct DisplacedMass {
  double body = 0;    ///< [kg]
  double medium = 0;  ///< [kg]

  bool isLighter() const { return body < medium; }
  /// So much that it rises at a good part of g, which hardly anybody means in air.
  bool isMuchLighter() const { return 2 * body < medium; }
};

/// In the medium around it now. @pre the body is dynamic.
DisplacedMass displacedMass(const AmbientBody& ambient);

/// Loads and model, in the medium where the body is now. What throws changes neither.
/// @throws std::invalid_argument as refreshModel().
void refresh(AmbientBody& ambient, AmbientBodies& bodies);

/// @throws std::invalid_argument that begins with `who` if there is no such way to meet a fluid.
/// What shape and medium can be, refresh() checks.
void checkDef(const std::string& who, const AttachDef& def);

/// Does what Fluid::add() does for a body, without the warning of light bodies.
/// @throws std::invalid_argument as Fluid::add().
AmbientBody& attachBody(AmbientBodies& bodies, btRigidBody& body, AttachDef def);

/// Warns once of bodies that are much lighter than the fluid that they displace: `def` and `mass`
/// are those of the lightest, `count` is how many there are.
void warnOfLightBody(Complaints& complaints, const AttachDef& def, const DisplacedMass& mass,
                     int count);

AMBIENT_END
