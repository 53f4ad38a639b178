#pragma once

#include <limits>

namespace ambient {

/// Pressure of the air outside a hold, and the weight of the water around it.
struct Outside {
  double atmosphere = 101325;  ///< pressure of the air at the surface [Pa]
  double weight = 9810;        ///< rho g of the water [N/m^3]
};

/// Air that water shuts off in a hold, or in several that it joins. It keeps pressure times volume,
/// docs/theory.md eq. (143).
struct SealedAir {
  double product = 0;  ///< pressure times volume [J]
  double volume = 0;   ///< [m^3]
  /// Pressure from which it leaves through the highest place of an opening, eq. (144) [Pa].
  double most = std::numeric_limits<double>::infinity();
  double kept = 0;  ///< volume that is left when water covers that place [m^3]
  /// Height of a place of an opening where the air outside can come in, eq. (145) [m].
  double inlet = std::numeric_limits<double>::infinity();

  /// Returns the product after water has come into the hold, whose level is then at a height.
  /// @param taken by the water; negative: given [m^3]
  double productAfter(double taken, double level, const Outside& outside) const noexcept;
  /// Returns its pressure then, less that of the atmosphere, over rho g [m].
  double headAfter(double taken, double level, const Outside& outside) const noexcept;
};

}  // namespace ambient
