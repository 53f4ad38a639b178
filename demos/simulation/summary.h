#pragma once

#include <string>
#include <vector>

#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/scene_run.h"

namespace ambient {

/// The text of summary.json: the scene's numbers, the work done, and for each body where it went
/// and, if it is flat, how it fell.
std::string makeSummary(const Scene& scene, const std::vector<PreparedBody>& bodies,
                        const RunRecord& record);

}  // namespace ambient
