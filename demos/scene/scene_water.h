#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "demos/scene/scene.h"

namespace ambient {

// Conversion of a scene's keys for water, regions and media. @pre the schema has accepted them

/// Reads a medium; missing keys are taken from `absent`.
Medium toMedium(const nlohmann::json& from, const Medium& absent);

WaterDef toWater(const nlohmann::json& from, const Vector3& gravity);

FluidRegion toRegion(const nlohmann::json& from);

/// Regions of a scene in the order in which to add them: the water, with the scene's medium above,
/// then the others. @throws std::invalid_argument naming value and limit.
std::vector<FluidRegion> makeRegions(const Scene& scene);

}  // namespace ambient
