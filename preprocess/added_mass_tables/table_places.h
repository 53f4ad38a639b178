#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Chebyshev series in two variables: sum over i, j of c_ij T_i(x) T_j(y), on [-1, 1]^2.
struct ChebyshevSeries {
  int rows = 0, columns = 0;             ///< i below rows, j below columns
  const double* coefficients = nullptr;  ///< row after row; lives as long as the program

  double operator()(double x, double y) const;
};

/// Added mass per unit density of a body of revolution about z, about the origin. The coupling is
/// K[w_y, v_x] = -K[w_x, v_y]; all that is not listed is 0 or follows by symmetry.
struct RevolutionInertia {
  double v_z = 0, v_x = 0, w_y = 0, coupling = 0;

  Matrix6 matrix() const {
    Matrix6 K = Matrix6::Zero();
    K(0, 0) = K(1, 1) = w_y;
    K(3, 3) = K(4, 4) = v_x;
    K(5, 5) = v_z;
    K(1, 3) = K(3, 1) = coupling;
    K(0, 4) = K(4, 0) = -coupling;
    return K;
  }
};

/// Largest ratio of longest to shortest extent in the tables; for a capsule: cylindrical part over
/// diameter.
constexpr double kLargestRatio = 100;
/// Largest rounding of a cone over rounding plus thickness r h / (r + h).
constexpr double kLargestRounding = 0.9;

/// Place of a shape in its table: logarithms of its ratios, mapped to [-1, 1]^2.
struct TablePlace {
  double x = 0, y = 0;

  bool isInside() const { return x >= -1 && x <= 1 && y >= -1 && y <= 1; }
};

// Tables hold the added mass divided by a simple scale with the same limits (plates, rods, balls),
// which is smooth and bounded; for translation the logarithm of that. Scales have no zeros near
// real ratios, so that the series converge fast. docs/theory.md eq. (73) and (74).

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

// Generated: tests/preprocess/added_mass_tables writes table_data.cpp.

/// Revision of the tables, part of a fluid body's provenance. Raise it with every change.
constexpr int kTableRevision = 1;

/// Rotation and logarithm of translation, over the scales of BoxAxis.
struct BoxTable {
  ChebyshevSeries rotation, translation;
};
const BoxTable& boxTable();

/// Entries over the scales of RoundPlace; of v_z and v_x the logarithms. A series without rows is
/// 0.
struct RoundTable {
  ChebyshevSeries v_z, v_x, w_y, coupling;
};
const RoundTable& cylinderTable();
const RoundTable& capsuleTable();
const RoundTable& coneTable();

}  // namespace ambient
