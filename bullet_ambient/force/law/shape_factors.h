#pragma once

#include "bullet_ambient/fluid_body/form_shape.h"
#include "bullet_ambient/force/law/wing_pressure.h"

namespace ambient {

/// Slope of the normal force of a thin plate of aspect ratio L, docs/theory.md eq. (43c): Helmbold
/// 1942. It is that of a slender wing, pi L/2 (Jones 1946), for small L, and 2 pi for large L.
double normalForceSlope(double aspect);

/// sigma of eq. (43a): sine of the incidence at which much of the flow around a plate separates.
double stallSine(double aspect);

/// A shape as the form law sees it: its numbers, and the constants that follow from them.
struct ShapeFactors {
  explicit ShapeFactors(const FormShape& shape);

  /// False of blocks: their faces follow eq. (43) without wings and slender hulls.
  bool actOnFaces() const { return shape.isWing() || shape.isSlender(); }
  /// tau of eq. (43e): share of the published pressure on a smooth body whose separation angle is
  /// more than pi/2.
  double slipShare(double separation_cosine) const;
  /// Share of the load that waits for the wake, 1 - epsilon of eq. (51d): 0 of boxes and plates.
  double wakeShare() const;

  FormShape shape;
  WingFactors<float> in_single;
  WingFactors<double> in_double;
};

}  // namespace ambient
