#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Returns the sum of two flows, each of which carries the other along, docs/theory.md eq. (172);
/// an empty one adds nothing.
FlowField operator+(FlowField a, FlowField b);

/// Mean wind over flat ground, docs/theory.md eq. (173). Heights along `up`.
struct WindProfile {
  Vector3 velocity{0, 0, 0};  ///< at `height`; its horizontal part counts [m/s]
  double height = 10;         ///< over the ground [m]
  /// z_0 of the logarithmic law [m]: 0.0002 of water, 0.03 of grass, 1 of a town; 0: power law.
  double roughness = 0.03;
  double exponent = 1.0 / 7;  ///< of the power law
  double ground = 0;          ///< up . x of ground or water [m]
  Vector3 up{0, 0, 1};        ///< against gravity, of any length
};
/// Makes a steady wind; none at the roughness's height and below. Cost: a logarithm or power.
/// @throws std::invalid_argument, naming value and limit, if a number is not physical.
FlowField windProfile(const WindProfile& wind);

/// Velocity of a current at a depth.
struct CurrentLevel {
  double depth = 0;           ///< below the surface at rest [m]
  Vector3 velocity{0, 0, 0};  ///< its horizontal part counts [m/s]
};
/// Makes a steady current: linear between levels, constant beyond them, none above the surface.
/// @param levels from the surface down
/// @param surface level of the water at rest along `up` [m]
/// @param up direction against gravity, of any length
/// @throws std::invalid_argument, naming level, value and limit, if there are none, if depths fall
/// or a number is not finite.
FlowField currentProfile(std::vector<CurrentLevel> levels, double surface = 0,
                         const Vector3& up = {0, 0, 1});

/// A gust that rises and falls by half a period of 1 - cos, everywhere at once, docs/theory.md eq.
/// (174). MIL-F-8785C: `rise` is d_m over the airspeed, and it stays (`hold` infinite); CS-25 and
/// FAR 25: `rise` is the gradient distance H over the airspeed, and `hold` is 0.
struct DiscreteGust {
  Vector3 velocity{0, 0, 0};  ///< at its peak [m/s]
  double start = 0;           ///< [s]
  double rise = 1;            ///< time from its start to its peak, and from that to its end [s]
  double hold = 0;            ///< time at its peak [s]
};
/// Makes a gust. Cost: a sine and a cosine while it changes.
/// @throws std::invalid_argument, naming value and limit, if a number is not physical.
FlowField discreteGust(const DiscreteGust& gust);

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
