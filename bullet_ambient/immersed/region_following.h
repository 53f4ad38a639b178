#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/fluid_regions.h"

AMBIENT_BEGIN

/// Puts a body into a medium for which it has a model. Returns false, and changes nothing, if it
/// has none. Allocates nothing.
bool enterMedium(AmbientBody& ambient, const RegionPlace& place, const Medium& medium) noexcept;

/// Finds the medium around a body that follows regions, at the start of a step of `duration` [s].
/// Cost: RegionIndex::find(), and one call of each function of the region. Allocates nothing.
void followRegions(AmbientBody& ambient, const FluidRegions& regions, double duration,
                   Complaints& complaints) noexcept;

/// Makes the models in all media that the body may meet, and puts the body into its own medium. If
/// this throws, nothing has changed.
/// @throws std::invalid_argument as makeFluidModels().
void refreshModels(AmbientBody& ambient, const FluidRegions& regions, ModelTables& tables);

/// Makes room for what differs of the fluid along a body, where a region may make it differ.
void takeStations(AmbientBody& ambient, const FluidRegions& regions);

AMBIENT_END
