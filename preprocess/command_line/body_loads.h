#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/face_loads.h"
#include "bullet_ambient/force/sphere_table.h"

namespace ambient {

/// The surface loads on a fluid body as a world has them by default, but for single precision: a
/// sphere as a smooth one, everything else on all faces.
class BodyLoads {
 public:
  /// Keeps a reference to the body.
  BodyLoads(const FluidBody& body, const LoadSettings& settings);

  /// Pressure and friction about the origin of F, for a twist relative to the fluid, both in F.
  FaceLoads at(const Twist& relative_twist) const;

 private:
  const FluidBody& body_;
  LoadSettings settings_;
  std::shared_ptr<const SphereTable> table_;  ///< null where none is needed
};

}  // namespace ambient
