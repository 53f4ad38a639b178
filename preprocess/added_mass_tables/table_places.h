#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/added_mass_tables/revolution_inertia.h"

namespace ambient {

/// Longest over shortest extent of the shapes in the tables; of a capsule the cylindrical part over
/// the diameter.
constexpr double kLargestRatio = 100;
/// Rounding of a cone over itself plus its thickness, r h / (r + h).
constexpr double kLargestRounding = 0.9;

/// Place of a shape in its table: logarithms of its ratios, mapped to [-1, 1]^2.
struct TablePlace {
  double x = 0, y = 0;

  bool isInside() const { return x >= -1 && x <= 1 && y >= -1 && y <= 1; }
};

// Tables hold an added mass over a simple scale that has its limits (plates, rods, balls), so that
// it is smooth and bounded; in translation the logarithm. Scales have no zeros near real ratios:
// they decide how fast the series converge. docs/theory.md eq. (73) and (74).

/// A box and one of its axes: half size a along it, b and c across [m]. Symmetric in b and c, so
/// that one table serves three axes.
struct BoxAxis {
  double a, b, c;

  TablePlace place() const;
  double translationScale() const;  ///< [m^3]
  double rotationScale() const;     ///< [m^5]
};

/// A body of revolution.
struct RoundPlace {
  TablePlace place;
  RevolutionInertia scale;
};

RoundPlace cylinderPlace(double radius, double height);
/// Height of the cylindrical part.
RoundPlace capsulePlace(double radius, double height);
/// Within `rounding` of a cone.
RoundPlace conePlace(double radius, double height, double rounding);

}  // namespace ambient
