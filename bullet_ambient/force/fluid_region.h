#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "bullet_ambient/force/medium.h"
#include "bullet_ambient/force/water_surface.h"

namespace ambient {

/// A box along the axes of W [m]. It holds its lower sides and not its upper ones, so that boxes
/// side by side leave no gap.
struct RegionBounds {
  Vector3 lowest{0, 0, 0};
  Vector3 highest{0, 0, 0};

  bool hold(const Vector3& point_W) const noexcept;
};

/// Velocity of a fluid [m/s] and acceleration of the fluid that is there [m/s^2], world axes.
struct FlowSample {
  Vector3 velocity{0, 0, 0};
  Vector3 acceleration{0, 0, 0};
};

/// A wind or current as a function of place and time [s]. Called as WaterSurface::sample().
using FlowField = std::function<FlowSample(const Vector3& point_W, double time)>;

/// A part of the world and the fluid in it: a wind zone, a current, a pool, the sea.
struct FluidRegion {
  std::optional<RegionBounds> bounds;  ///< none: everywhere
  Medium below = {};                   ///< the fluid below the surface; without one, everywhere
  Medium above = {};                   ///< that above it
  std::shared_ptr<const WaterSurface> surface = nullptr;  ///< null: filled with `below`
  /// Added to the velocity and acceleration of the medium, those of waves to that of the water:
  /// sampled at the centre of mass of each body at the start of each step.
  FlowField flow = nullptr;
  int priority = 0;  ///< where regions overlap, the highest counts; of equal ones the last added
};

/// Whether what moves in it is always the same: no function and no moving surface.
inline bool isSteady(const FluidRegion& region) {
  return !region.flow && (!region.surface || region.surface->isStill());
}

/// The fluids of a region around a point: surface and flow sampled.
struct RegionSample {
  Medium below, above;
  double height = 0;  ///< of the surface above the point, vertically [m]; infinite without one
  /// False if surface or flow are not: the media then are without both.
  bool is_finite = true;

  bool isAbove() const { return !(height > 0); }  ///< the point is dry
  const Medium& here() const { return isAbove() ? above : below; }
};
RegionSample sampleRegion(const FluidRegion& region, const Vector3& point_W, double time) noexcept;

/// @throws std::invalid_argument, naming value and limit, if bounds or media are not physical.
void checkRegion(const FluidRegion& region);

}  // namespace ambient
