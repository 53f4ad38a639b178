#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "demos/scene/scene.h"

namespace ambient {

// Keys of a scene that say which fluid is where. @pre the schema has let them pass.

/// A medium; `absent`: of the keys that are left out.
Medium toMedium(const nlohmann::json& from, const Medium& absent);

WaterDef toWater(const nlohmann::json& from, const Vector3& gravity);

FluidRegion toRegion(const nlohmann::json& from);

/// The scene's water, with its medium above, and its other regions, in the order in which they are
/// to be added. @throws std::invalid_argument naming value and limit.
std::vector<FluidRegion> makeRegions(const Scene& scene);

}  // namespace ambient
