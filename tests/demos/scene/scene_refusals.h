#pragma once

#include "tests/demos/scene/scene_text.h"
#include "tests/support/refusals.h"

namespace ambient {

/// Expects what a group of refusals.json says of changes to a scene.
inline void expectSceneRefusals(const std::string& group, const nlohmann::json& scene) {
  expectRefusals(AMBIENT_SCENE_REFUSALS, group, [&scene](const nlohmann::json& changes) {
    return complaintAbout(withChanges(scene, changes));
  });
}

}  // namespace ambient
