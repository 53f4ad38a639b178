#pragma once

#include <vector>

#include "preprocess/potential_flow/surface/panel_pair.h"

namespace ambient {

/// Lists for every panel the near panels, itself included, ascending: those that the far-field
/// formula does not cover.
struct NearPanels {
  struct Entry {
    int panel;
    PairKind kind;
    double integral;  ///< computePairIntegral(), the same number for (t, s) and (s, t)
  };
  std::vector<std::vector<Entry>> of_panel;
};

/// Finds the near panels and integrates each near pair once. Cost: O(panels^2) tests.
NearPanels findNearPanels(const PanelSurface& surface, int threads);

}  // namespace ambient
