#pragma once

#include <string>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/fluid_body/displaced_mass.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"

class btRigidBody;

AMBIENT_BEGIN

class AmbientBodies;

/// Computes both masses in the medium around the body now. A body in a region with a water surface
/// counts as floating. @pre the body was dynamic when its models were made
DisplacedMass displacedMass(const AmbientBody& ambient);

/// Makes the models of a body or link again, in the medium around it now. If this throws, nothing
/// has changed.
/// @throws std::invalid_argument as refreshModels().
void refresh(AmbientBody& ambient, const InverseMass& mass, const MotionView& now,
             AmbientBodies& bodies);

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
