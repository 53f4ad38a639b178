#pragma once

#include <vector>

#include "preprocess/potential_flow/surface/panel_pair.h"

namespace ambient {

/// For every panel the others (and itself) that its far field does not cover, in ascending order.
struct NearPanels {
  struct Entry {
    int panel;
    PairKind kind;
    double integral;  ///< computePairIntegral(), the same number for (t, s) and (s, t)
  };
  std::vector<std::vector<Entry>> of_panel;
};

/// Cost: all pairs are looked at, the near ones integrated once.
NearPanels findNearPanels(const PanelSurface& surface, int threads);

}  // namespace ambient
