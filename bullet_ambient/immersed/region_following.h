#pragma once

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/fluid_regions.h"

AMBIENT_BEGIN

/// Loads and models of one body in some fluids.
struct KnownFluids {
  std::vector<MediumLoads> media;
  std::vector<SurfaceMedia> surfaces;  ///< of unit mass and inertia until its model is built
};

/// The loads of a body in its own medium.
/// @throws std::invalid_argument as makeSurfaceLoads().
MediumLoads makeOwnLoads(const AttachDef& def, LoadTables& tables);

/// Makes them for a body in the fluids of regions, but for its own medium; none, if it follows no
/// regions.
/// @throws std::invalid_argument as makeSurfaceLoads() and makeSurfaceModel().
KnownFluids makeKnownFluids(const AttachDef& def, const RegionFluids& fluids, LoadTables& tables);

/// Between steps, before regions have fluids that the body does not know. Its model is stale then,
/// if there are new surfaces.
void learnFluids(AmbientBody& ambient, KnownFluids fluids);

/// Between steps, after no region has these fluids any more. The body stays at its surface, if that
/// is not among them.
void forgetFluids(AmbientBody& ambient, const RegionFluids& fluids);

/// Puts a body into a medium whose loads it has; the model is stale then, if density or viscosity
/// are others than before. False if it has none. Allocates nothing.
bool enterMedium(AmbientBody& ambient, const RegionPlace& place, const Medium& medium) noexcept;

/// At the start of a step of `duration` [s]: finds the medium around a body that follows regions.
/// Cost: RegionIndex::find(), and a call of the functions of its region. Allocates nothing. Whether
/// density or viscosity are others than before: the model is stale then.
bool followRegions(AmbientBody& ambient, const FluidRegions& regions, double duration,
                   Complaints& complaints) noexcept;

/// Makes the loads in all media that the body may meet, puts it into its own, and builds the model
/// if it is dynamic at present, or else when it next is: until then, it has one of unit mass and
/// inertia. What throws changes nothing.
/// @throws std::invalid_argument as makeSurfaceLoads() and makeBodyModel().
void refreshModel(AmbientBody& ambient, const FluidRegions& regions, LoadTables& tables);

AMBIENT_END
