#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

struct ShapeFactors;

/// Scales the form law to measured drag coefficients, docs/theory.md eq. (51): the part of the
/// loads on faces that brakes the motion gets a positive factor, so that it still takes energy.
/// Lift stays. Frame F.
class DragScale {
 public:
  /// Computes the law's own drag on `faces`, which need their sharpness. Cost O(F).
  DragScale(const FluidBody& body, const FaceTable& faces, const ShapeFactors& shape);

  /// Returns `load`, the load on the faces in a twist relative to the flow, with its drag scaled.
  Wrench scaled(const Wrench& load, const Twist& relative_twist) const noexcept;

 private:
  bool is_measured_;
  Vector3 scales_{1, 1, 1};  ///< sigma_j: measured coefficient over the law's own
  Vector3 centre_;           ///< centre of volume [m]
  double length_sq_;         ///< area in eq. (51) [m^2]
};

}  // namespace ambient
