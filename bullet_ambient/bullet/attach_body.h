#pragma once

#include <string>

#include "bullet_ambient/bullet/attach_def.h"
#include "bullet_ambient/bullet/precision_check.h"

class btRigidBody;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

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

/// AmbientRegistry::attach() but for what is said of light bodies.
/// @throws std::invalid_argument as AmbientRegistry::attach().
void attachBody(AmbientBodies& bodies, btRigidBody& body, AttachDef def);

/// Says once, of one body that is much lighter than what it displaces, both masses, and how many
/// are.
void sayLight(Complaints& complaints, const FluidBody& shape, const DisplacedMass& mass, int count);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
