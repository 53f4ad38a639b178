#pragma once

#include <string>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/attach_def.h"

class btRigidBody;

AMBIENT_BEGIN

struct AmbientBody;
class AmbientBodies;
class Complaints;

/// Mass of a body, and mass of the medium that it displaces.
struct DisplacedMass {
  double body = 0;    ///< [kg]
  double medium = 0;  ///< [kg]

  bool isLighter() const { return body < medium; }
  /// True if the body has less than half the mass of the medium and so rises fast, which is hardly
  /// meant in air.
  bool isMuchLighter() const { return 2 * body < medium; }
};

/// Computes both masses in the medium around the body now. A body in a region with a water surface
/// counts as floating: its displaced mass is 0. @pre the body is dynamic
DisplacedMass displacedMass(const AmbientBody& ambient);

/// Makes the models of a body again, in the medium around it now. If this throws, nothing has
/// changed.
/// @throws std::invalid_argument as refreshModels().
void refresh(AmbientBody& ambient, AmbientBodies& bodies);

/// Checks the flight settings and enumerators of a definition; refresh() checks shape and medium.
/// @throws std::invalid_argument that begins with `who`.
void checkDef(const std::string& who, const AttachDef& def);

/// Implements Fluid::add() for a body, except the warning about light bodies.
/// @throws std::invalid_argument as Fluid::add().
AmbientBody& attachBody(AmbientBodies& bodies, btRigidBody& body, AttachDef def);

/// Warns once of bodies much lighter than the medium that they displace. `def`, `mass`: of the
/// lightest body in proportion; `count`: number of such bodies.
void warnOfLightBody(Complaints& complaints, const AttachDef& def, const DisplacedMass& mass,
                     int count);

AMBIENT_END
