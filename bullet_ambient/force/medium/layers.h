#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Density of a fluid at a height.
struct DensityLevel {
  double height = 0;   ///< along the layers' up [m]
  double density = 0;  ///< [kg/m^3]
};

/// Density of a fluid over height: linear between levels, constant beyond the first and the last.
/// Two levels of one height are a step.
class DensityLayers {
 public:
  /// @param levels from the lowest on
  /// @param up direction against gravity, of any length
  /// @throws std::invalid_argument, naming level, value and limit, if there are none, if heights
  /// fall or a number is not physical.
  DensityLayers(std::vector<DensityLevel> levels, const Vector3& up);

  /// Density at a height [m]; on a step that below it [kg/m^3].
  double density(double height) const noexcept;
  const std::vector<DensityLevel>& levels() const noexcept { return levels_; }
  const Vector3& up() const noexcept { return up_; }  ///< unit

 private:
  std::vector<DensityLevel> levels_;
  Vector3 up_;
};

/// Makes the density of a region, FluidRegion::layers: a thermocline, a halocline, two fluids.
/// @throws std::invalid_argument as DensityLayers.
std::shared_ptr<const DensityLayers> layers(std::vector<DensityLevel> levels,
                                            const Vector3& up = {0, 0, 1});

/// Returns air at rest of the U.S. Standard Atmosphere 1976, docs/theory.md eq. (179).
/// @param height over the sea, geometric [m]
/// @throws std::invalid_argument if the height is not from -5000 to 86000.
Medium standardAtmosphere(double height);

/// Makes the density of that air between two heights, with a level every 100 m, which errs by less
/// than 3e-5.
/// @param lowest geometric height over the sea, which lies at 0 along `up` [m]
/// @param highest above it [m]
/// @param up direction against gravity
/// @throws std::invalid_argument as standardAtmosphere(), or if `highest` is not above `lowest`.
std::shared_ptr<const DensityLayers> airLayers(double lowest, double highest,
                                               const Vector3& up = {0, 0, 1});

}  // namespace ambient
