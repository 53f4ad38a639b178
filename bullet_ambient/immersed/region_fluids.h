#pragma once

#include <optional>
#include <tuple>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/medium/fluid_region.h"

AMBIENT_BEGIN

/// Properties of a medium on which surface loads depend. Media that differ in velocity only share
/// their loads.
struct FluidKind {
  double density = 0;    ///< [kg/m^3]
  double viscosity = 0;  ///< [Pa s]

  explicit FluidKind(const Medium& medium) : density(medium.density), viscosity(medium.viscosity) {}
  friend bool operator==(const FluidKind& a, const FluidKind& b) {
    return a.density == b.density && a.viscosity == b.viscosity;
  }
  friend bool operator<(const FluidKind& a, const FluidKind& b) {
    return std::tie(a.density, a.viscosity) < std::tie(b.density, b.viscosity);
  }
  /// Returns the medium at rest with these properties.
  Medium medium() const { return {density, viscosity, Vector3::Zero(), Vector3::Zero()}; }
};

/// True if a fluid above a water surface moves, so that it is wind.
inline bool mayBlow(const Medium& medium) { return !medium.velocity.isZero(0); }

/// Properties of the two fluids at a water surface on which the model of a body there depends.
struct SurfaceKind {
  FluidKind below;
  std::optional<FluidKind> above;  ///< unset: unnamedAbove() decides for each body
  bool may_blow;                   ///< true: the region's fluid above may move

  explicit SurfaceKind(const FluidRegion& region)
      : below(region.below), may_blow(region.flow || (region.above && mayBlow(*region.above))) {
    if (region.above) above.emplace(*region.above);
  }
  /// Returns the fluid above for a body whose own medium is `own`.
  Medium mediumAbove(const Medium& own) const {
    return above ? above->medium() : unnamedAbove(below.density, own);
  }
  friend bool operator==(const SurfaceKind& a, const SurfaceKind& b) {
    return a.below == b.below && a.above == b.above && a.may_blow == b.may_blow;
  }
  friend bool operator<(const SurfaceKind& a, const SurfaceKind& b) {
    return std::tie(a.below, a.above, a.may_blow) < std::tie(b.below, b.above, b.may_blow);
  }
};

/// A set of fluids of regions, each once.
struct RegionFluids {
  std::vector<FluidKind> media;
  std::vector<SurfaceKind> surfaces;

  bool empty() const noexcept { return media.empty() && surfaces.empty(); }
};

AMBIENT_END
