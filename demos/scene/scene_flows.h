#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bullet_ambient/force/medium/fluid_region.h"

namespace ambient {

/// Reads the value of a key "flow": the sum of its entries. `up`: against gravity. @pre the schema
/// has accepted it
/// @throws std::invalid_argument naming flow, value and limit.
FlowField toFlow(const nlohmann::json& from, const Vector3& up);

/// Gives a region what the keys "flow", "flow_above" and "layers" of a water or region say,
/// likewise; `upward` may be 0 in a world without gravity, and is then z.
/// @throws std::invalid_argument as toFlow(), or naming level, value and limit.
void readFlows(const nlohmann::json& from, const Vector3& upward, FluidRegion& region);

}  // namespace ambient
