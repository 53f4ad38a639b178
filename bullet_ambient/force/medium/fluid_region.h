#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Axis-aligned box in W [m]. The lower sides belong to the box, the upper sides do not: adjacent
/// boxes leave no gap.
struct RegionBounds {
  Vector3 lowest{0, 0, 0};
  Vector3 highest{0, 0, 0};

  bool hold(const Vector3& point_W) const noexcept;
};

class DensityLayers;

/// Velocity [m/s] and acceleration [m/s^2] of the fluid at a point, world axes.
struct FlowSample {
  Vector3 velocity{0, 0, 0};
  /// Acceleration of a particle that this flow alone carries, docs/theory.md eq. (172) [m/s^2].
  Vector3 acceleration{0, 0, 0};
  /// Rows: gradients of the components of the velocity [1/s]. Read where other flows carry this one
  /// along; where it is left out, that part of the acceleration is missing.
  Matrix3 gradient = Matrix3::Zero();
};

/// Returns the sum of two flows at a point, of which each carries the other along, docs/theory.md
/// eq. (172).
FlowSample sumOf(const FlowSample& a, const FlowSample& b) noexcept;

/// Wind or current as a function of place [m] and time [s]; WaterSurface::sample() has the rules.
using FlowField = std::function<FlowSample(const Vector3& point_W, double time)>;

/// Part of the world and the fluid in it: a wind zone, a current, a pool, the sea.
struct FluidRegion {
  std::optional<RegionBounds> bounds;  ///< none: everywhere
  Medium below = {};                   ///< the fluid below the surface; without one, everywhere
  /// The fluid above the surface; unset: unnamedAbove(). A vacuum is `Medium{}`.
  std::optional<Medium> above = std::nullopt;
  std::shared_ptr<const WaterSurface> surface = nullptr;  ///< null: filled with `below`
  /// Wind or current, added to velocity and acceleration of the media. Velocity and acceleration of
  /// waves are added to `below`. Sampled along each body at the start of each step, docs/theory.md
  /// eq. (83). Where it gives no acceleration, that is how its velocity changes, see BareVelocity.
  FlowField flow = nullptr;
  /// Wind over a surface, added to `above` alone. A body that the surface cuts samples it in the
  /// middle of its dry height.
  FlowField flow_above = nullptr;
  /// Density of `below` over height in place of Medium::density, which stays the one that added
  /// mass is computed with; null: the same everywhere. docs/theory.md eq. (180).
  std::shared_ptr<const DensityLayers> layers = nullptr;
  int priority = 0;  ///< in overlaps the highest priority wins; if equal, the region added last
};

/// Makes a region of water at rest everywhere below z = `level` [m], under air.
/// @throws std::invalid_argument if the level is not finite.
FluidRegion waterBelow(double level);

/// Makes a region of air that moves with a velocity [m/s] within bounds.
FluidRegion windZone(const RegionBounds& bounds, const Vector3& velocity);

/// True if a function gives the velocity of a region's fluid.
inline bool hasFlow(const FluidRegion& region) {
  return region.flow || (region.surface && region.flow_above);
}
/// True if the fluid of a region does not change with time: no flow function and no moving surface.
inline bool isSteady(const FluidRegion& region) {
  return !hasFlow(region) && (!region.surface || region.surface->isStill());
}

/// Returns the fluid above a surface where FluidRegion::above is unset: a body's own medium if it
/// has a density [kg/m^3] and that is below the water's, else air at rest.
Medium unnamedAbove(double water_density, const Medium& own);

/// Part of a fluid's velocity at a point that no acceleration is given for: the sum over medium,
/// waves and flow where their acceleration is zero. Its change with time is an acceleration of the
/// fluid, docs/theory.md eq. (19a).
struct BareVelocity {
  Vector3 velocity{0, 0, 0};  ///< [m/s]
  unsigned parts = 0;         ///< which of the three are in it: 1, 2 and 4

  /// Adds one of the three if it has no acceleration.
  void add(unsigned part, const Vector3& part_velocity, const Vector3& acceleration) noexcept {
    if (!acceleration.isZero(0)) return;
    velocity += part_velocity;
    parts |= part;
  }
};
/// Returns that of a medium which is in no region.
BareVelocity bareVelocityOf(const Medium& medium) noexcept;

/// The fluids of a region around a point: surface and flow sampled.
struct RegionSample {
  Medium below, above;
  double height = 0;  ///< surface above the point, vertically [m]; infinite without a surface
  /// False if a sample of surface or flow was not finite; the media then lack both samples.
  bool is_finite = true;
  BareVelocity bare_below = {}, bare_above = {};  ///< without parts if a sample was not finite
  /// Slope of the surface beyond the one that its acceleration gives, horizontal, in W; of a body
  /// that is not small against the waves, docs/theory.md eq. (84) [1].
  Vector3 tilt = {0, 0, 0};

  bool isAbove() const { return !(height > 0); }  ///< true if the point is dry
  const Medium& here() const { return isAbove() ? above : below; }
};
/// Samples surface and flow of a region at a point and time [s], for a body whose own medium is
/// `own`. `half_height`: of the body [m]; FluidRegion::flow_above is sampled in the middle of what
/// of it is dry.
RegionSample sampleRegion(const FluidRegion& region, const Vector3& point_W, double time,
                          const Medium& own = {}, double half_height = 0) noexcept;

/// Checks a region. @throws std::invalid_argument, naming value and limit, if bounds or media are
/// not physical, or the medium below a surface is a vacuum.
void checkRegion(const FluidRegion& region);

/// Number of a region of one Fluid: from 0, in the order of addition; never used twice.
enum class RegionId : int { kNone = -1 };

/// Place of a body among the regions at the start of its last step.
struct RegionLocation {
  RegionId region = RegionId::kNone;
  bool is_above = false;       ///< true: the body is above the region's surface
  bool is_at_surface = false;  ///< true: the surface cuts the body or is near

  friend bool operator==(const RegionLocation& a, const RegionLocation& b) {
    return a.region == b.region && a.is_above == b.is_above && a.is_at_surface == b.is_at_surface;
  }
};

/// Memory of a body's last substep: the velocity that its fluid had there, of the part without a
/// given acceleration, BareVelocity.
struct FlowMemory {
  double until = -1;  ///< Fluid::time() at the end of the substep [s]; negative: there was none
  Vector3 position{0, 0, 0};  ///< of the centre of mass at its start, in W; in a region [m]
  Vector3 velocity{0, 0, 0};  ///< of the fluid there at its end, in W [m/s]
  Vector3 change{0, 0, 0};    ///< of the fluid's velocity that AmbientBody::medium lacks [m/s]
  unsigned parts = 0;         ///< BareVelocity::parts
  RegionId region = RegionId::kNone;
  bool is_above = false;  ///< true: of the fluid above the region's surface
};

}  // namespace ambient
