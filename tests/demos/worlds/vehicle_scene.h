#pragma once

#include "tests/demos/scene/scene_text.h"

namespace ambient {

/// Scene: a box of unequal sides with two thrusters, deep in water that stands still.
inline nlohmann::json vehicle() {
  nlohmann::json scene = ballScene();
  scene["medium"] = {{"density", 1000}, {"viscosity", 1e-3}};
  scene["bodies"] = nlohmann::json::array({{{"name", "hull"},
                                            {"shape", {{"type", "box"}, {"size", {0.5, 0.3, 0.2}}}},
                                            {"mass", 31},
                                            {"position", {0, 0, 1}}}});
  const nlohmann::json curve = {{-1, -30}, {0, 0}, {1, 40}};
  scene["thrusters"] = nlohmann::json::array(
      {{{"on", "hull"}, {"position", {-0.2, 0.1, 0}}, {"curve", curve}, {"lag", 0.1}},
       {{"on", "hull"}, {"position", {-0.2, -0.1, 0}}, {"curve", curve}, {"lag", 0.1}}});
  return scene;
}

}  // namespace ambient
