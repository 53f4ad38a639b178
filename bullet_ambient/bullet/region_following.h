#pragma once

#include <vector>

#include "bullet_ambient/bullet/ambient_body.h"
#include "bullet_ambient/bullet/complaints.h"
#include "bullet_ambient/bullet/fluid_regions.h"
#include "bullet_ambient/bullet/precision_check.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The loads of a body in its own medium, which come first, and in those of the regions that it
/// follows; each density with each viscosity once. Takes over what is `known`, which must be of the
/// same shape and flow settings.
/// @throws std::invalid_argument as makeSurfaceLoads().
std::vector<MediumLoads> makeMediumLoads(const AttachDef& def, const FluidRegions& regions,
                                         LoadTables& tables, const std::vector<MediumLoads>& known);

/// The same for the pairs of fluids that a surface parts; of unit mass and inertia until the body's
/// model is built.
/// @throws std::invalid_argument as makeSurfaceModel().
std::vector<SurfaceMedia> makeSurfaceMedia(const AttachDef& def, const FluidRegions& regions,
                                           LoadTables& tables,
                                           const std::vector<SurfaceMedia>& known);

/// Between steps, after the regions have changed: the body stays at its surface, if that is there.
void replaceSurfaces(AmbientBody& ambient, std::vector<SurfaceMedia> surfaces);

/// Puts a body into a medium whose loads it has; the model is stale then, if density or viscosity
/// are others than before. False if it has none. Allocates nothing.
bool enterMedium(AmbientBody& ambient, const RegionPlace& place, const Medium& medium) noexcept;

/// At the start of a step of `duration` [s]: finds the medium around a body that follows regions.
/// Cost: a comparison with the bounds of each region of higher priority than its own. Allocates
/// nothing. Whether density or viscosity are others than before: the model is stale then.
bool followRegions(AmbientBody& ambient, const FluidRegions& regions, double duration,
                   Complaints& complaints) noexcept;

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
