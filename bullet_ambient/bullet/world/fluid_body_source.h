#pragma once

#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"

class btCollisionShape;

namespace ambient {

struct FluidBody;
}  // namespace ambient

AMBIENT_BEGIN

/// Interface for finding the fluid body of a collision shape. FluidBodyCache makes fluid bodies by
/// the preprocessor, which the runtime does not link; a program may derive from this class and use
/// its own table.
class FluidBodySource {
 public:
  virtual ~FluidBodySource() = default;

  /// Returns the fluid body of a shape, in the frame of the shape, which is also that of a
  /// btRigidBody with this shape. @throws std::exception with one line that says why there is none.
  virtual std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape& shape) = 0;
};

AMBIENT_END
