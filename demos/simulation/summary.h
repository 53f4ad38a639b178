#pragma once

#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/scene_run.h"

namespace ambient {

/// Text of summary.json: numbers of the scene, computational work, and for each body its path and,
/// if it is a plate, its falling mode.
std::string makeSummary(const Scene& scene, const std::vector<PreparedBody>& bodies,
                        const RunRecord& record);

}  // namespace ambient
