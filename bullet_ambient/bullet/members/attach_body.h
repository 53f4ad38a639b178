#pragma once

#include <string>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/fluid_body/displaced_mass.h"
#include "bullet_ambient/immersed/attach_def.h"

class btRigidBody;

AMBIENT_BEGIN

struct AmbientBody;
class AmbientBodies;
class Complaints;

/// Computes both masses in the medium around the body now. A body in a region with a water surface
/// counts as floating. @pre the body is dynamic
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
