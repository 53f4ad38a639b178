#include "preprocess/potential_flow/operators/near_panels.h"

#include <algorithm>

#include "preprocess/base/parallel_for.h"

namespace ambient {

NearPanels findNearPanels(const PanelSurface& surface, int threads) {
  NearPanels near;
  const Eigen::Index n = surface.panelCount();
  near.of_panel.resize(n);
  parallelFor(threads, n, [&](std::ptrdiff_t t) {
    for (Eigen::Index s = 0; s < n; ++s) {
      const PairKind kind = classifyPair(surface, t, s);
      if (kind == PairKind::Far) continue;
      const double integral = s >= t ? computePairIntegral(surface, t, s) : 0;
      near.of_panel[t].push_back({static_cast<int>(s), kind, integral});
    }
  });
  parallelFor(threads, n, [&](std::ptrdiff_t t) {
    for (NearPanels::Entry& entry : near.of_panel[t]) {
      if (entry.panel >= t) break;
      const auto& mirror = near.of_panel[entry.panel];
      entry.integral = std::lower_bound(mirror.begin(), mirror.end(), t,
                                        [](const NearPanels::Entry& e, std::ptrdiff_t panel) {
                                          return e.panel < panel;
                                        })
                           ->integral;
    }
  });
  return near;
}

}  // namespace ambient
