#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "demos/scene/scene.h"

namespace ambient {

// Conversion of a scene's keys for water, regions and media. @pre the schema has accepted them

/// Reads a medium; missing keys are taken from `absent`.
Medium toMedium(const nlohmann::json& from, const Medium& absent);

/// Reads a water. @throws std::invalid_argument as readFlows().
WaterDef toWater(const nlohmann::json& from, const Vector3& gravity);

/// Reads a region. @throws std::invalid_argument as readFlows().
FluidRegion toRegion(const nlohmann::json& from, const Vector3& gravity);

/// Reads the key "bounds"; none if it is missing.
std::optional<RegionBounds> toBounds(const nlohmann::json& parent);

/// Makes the region of a water; `above`: the fluid above its surface, unset as in FluidRegion.
FluidRegion makeWaterRegion(const WaterDef& water, const std::optional<Medium>& above);

/// Regions of a scene in the order in which to add them: the water, with the scene's medium above,
/// then the others. @throws std::invalid_argument naming value and limit.
std::vector<FluidRegion> makeRegions(const Scene& scene);

}  // namespace ambient
