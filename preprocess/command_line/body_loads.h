#pragma once

#include <memory>

#include "bullet_ambient/force/surface_loads.h"

namespace ambient {

/// The surface loads on a fluid body as a world has them by default, but in double precision. Both
/// in F.
class BodyLoads {
 public:
  BodyLoads(FluidBody body, const Medium& medium, const FlowSettings& flow);

  /// About the origin of F, for a twist relative to the fluid.
  FaceLoads at(const Twist& relative_twist) const;

 private:
  std::shared_ptr<const SurfaceLoads> loads_;  ///< null: none
  FrameOffset frame_;                          ///< theirs
};

}  // namespace ambient
