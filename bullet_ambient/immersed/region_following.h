#pragma once

#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/immersed/warnings.h"

namespace ambient {

/// Puts a body into a medium for which it has a model. Returns false, and changes nothing, if it
/// has none. Allocates nothing.
bool enterMedium(AmbientBody& ambient, const RegionLocation& location,
                 const Medium& medium) noexcept;

/// True if regions may decide on the medium around a body.
inline bool mayBeInRegion(const AmbientBody& ambient, const FluidRegions& regions) noexcept {
  return ambient.def->follow_regions && !regions.empty();
}

/// Finds the medium around a body at the start of a step of `duration` [s]. Cost:
/// RegionIndex::find(), and one call of each function of the region. Allocates nothing.
/// @pre mayBeInRegion()
void followRegions(AmbientBody& ambient, const MotionView& now, const FluidRegions& regions,
                   double duration, Warnings& warnings) noexcept;
/// Puts a body into its own medium, at the start of a step. @pre not mayBeInRegion()
void stayInOwnMedium(AmbientBody& ambient, const FluidRegions& regions, double duration) noexcept;

/// Makes the models in all media that the body may meet, and puts the body into its own medium. If
/// this throws, nothing has changed.
/// @throws std::invalid_argument as makeFluidModels().
void refreshModels(AmbientBody& ambient, const InverseMass& mass, const FluidRegions& regions,
                   ModelTables& tables);

/// Makes room for what differs of the fluid along a body, where a region may make it differ.
void makeStations(AmbientBody& ambient, const FluidRegions& regions);

}  // namespace ambient
