#pragma once

#include <memory>
#include <utility>

#include "bullet_ambient/force/loads/surface_loads.h"

namespace ambient {

/// Surface loads on a fluid body, as in a world by default, but in double precision. Twists and
/// wrenches in F.
class BodyLoads {
 public:
  BodyLoads(const std::shared_ptr<const FluidBody>& body, const Medium& medium,
            const FlowSettings& flow);
  BodyLoads(FluidBody body, const Medium& medium, const FlowSettings& flow)
      : BodyLoads(std::make_shared<const FluidBody>(std::move(body)), medium, flow) {}

  /// Computes the loads about the origin of F, for a twist relative to the fluid.
  FaceLoads at(const Twist& relative_twist) const;

 private:
  std::shared_ptr<const SurfaceLoads> loads_;  ///< null: none
  FrameOffset frame_;                          ///< pose in F of the frame of the loads
};

}  // namespace ambient
