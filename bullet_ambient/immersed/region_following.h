#pragma once

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/fluid_regions.h"

AMBIENT_BEGIN

/// Loads and surface models of one body for a set of fluids.
struct KnownFluids {
  std::vector<MediumLoads> media;
  std::vector<SurfaceMedia> surfaces;  ///< with mass 1 kg and inertia 1 kg m^2 until buildModel()
};

/// Makes the loads of a body in its own medium.
/// @throws std::invalid_argument as makeSurfaceLoads().
MediumLoads makeOwnLoads(const AttachDef& def, LoadTables& tables);

/// Makes loads and surface models of a body for the fluids of regions, its own medium excepted.
/// Returns none if the body follows no regions.
/// @throws std::invalid_argument as makeSurfaceLoads() and makeSurfaceModel().
KnownFluids makeKnownFluids(const AttachDef& def, const RegionFluids& fluids, LoadTables& tables);

/// Adds fluids that the body does not know yet. Call between steps, before a region has them. New
/// surfaces make the model stale.
void learnFluids(AmbientBody& ambient, KnownFluids fluids);

/// Removes fluids that no region has any more. Call between steps. The body stays at its surface
/// unless that one is removed.
void forgetFluids(AmbientBody& ambient, const RegionFluids& fluids);

/// Puts a body into a medium for which it has loads. A new density or viscosity makes the model
/// stale. Returns false, and changes nothing, if the body has no loads for the medium. Allocates
/// nothing.
bool enterMedium(AmbientBody& ambient, const RegionPlace& place, const Medium& medium) noexcept;

/// Finds the medium around a body that follows regions, at the start of a step of `duration` [s].
/// Returns true if density or viscosity have changed; the model is then stale. Cost:
/// RegionIndex::find(), and one call of each function of the region. Allocates nothing.
bool followRegions(AmbientBody& ambient, const FluidRegions& regions, double duration,
                   Complaints& complaints) noexcept;

/// Makes the loads in all media that the body may meet, puts the body into its own medium, and
/// builds the model. A body that is not dynamic at present gets buildUnitModel(). If this throws,
/// nothing has changed.
/// @throws std::invalid_argument as makeSurfaceLoads() and makeBodyModel().
void refreshModel(AmbientBody& ambient, const FluidRegions& regions, LoadTables& tables);

AMBIENT_END
