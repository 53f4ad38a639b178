#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Brings the form law to drag coefficients that were measured: a positive factor on all that the
/// faces do, so that they go on taking energy. docs/theory.md eq. (51). Frame F.
class DragScale {
 public:
  /// `faces` with sharpness. Cost O(F).
  DragScale(const FluidBody& body, const FaceTable& faces);

  /// For a twist relative to the flow; 1 for a body without measured coefficients, and at rest.
  double factor(const Twist& relative_twist) const noexcept;

 private:
  bool is_measured_;
  Vector3 scales_{1, 1, 1};  ///< per axis: measured over the law's
  Vector3 centre_;           ///< of volume [m]
  double length_sq_;         ///< that makes a spin a speed, squared [m^2]
};

}  // namespace ambient
