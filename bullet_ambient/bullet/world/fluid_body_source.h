#pragma once

#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"

class btCollisionShape;

namespace ambient {

struct FluidBody;
}  // namespace ambient

AMBIENT_BEGIN

/// Whoever knows the fluid bodies of collision shapes: FluidBodyCache makes them by the
/// preprocessor, which the runtime does not link; a program may have a table of its own.
class FluidBodySource {
 public:
  virtual ~FluidBodySource() = default;

  /// The fluid body of a shape, in the shape's frame, which is that of a btRigidBody with it.
  /// @throws std::exception with one line that says why there is none.
  virtual std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape& shape) = 0;

  /// Changes when fluidBody() has come to know a better answer for a shape that it was asked for.
  /// Asked in every substep: cheap, and from the thread that steps the world.
  virtual unsigned revision() const noexcept { return 0; }
};

AMBIENT_END
