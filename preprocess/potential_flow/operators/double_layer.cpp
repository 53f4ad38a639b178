#include "preprocess/potential_flow/operators/double_layer.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/potential_flow/operators/far_moments.h"

namespace ambient {

using Eigen::Index;

PanelMoments computeExteriorMoments(const PanelSurface& surface, const NearPanels& near,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads) {
  constexpr Index kAtOnce = FarMoments::kTargetsAtOnce;
  const Index panels = surface.panelCount();
  AMBIENT_ASSERT(jump.rows() == surface.vertexCount());
  AMBIENT_ASSERT(near.of_panel.size() == static_cast<std::size_t>(panels));
  const std::vector<PanelJump> jumps = makePanelJumps(surface, jump);
  const FarMoments far(surface, jumps);
  PanelMoments moments(panels, Eigen::Matrix<double, 3, 6>::Zero());
  parallelFor(threads, (panels + kAtOnce - 1) / kAtOnce, [&](Index block) {
    const Index first = block * kAtOnce, count = std::min(kAtOnce, panels - first);
    far.add({{0, panels}}, {first, count}, near.of_panel.data() + first, moments);
    for (Index t = first; t < first + count; ++t) {
      moments[t] += computeNearMoments(surface, near.of_panel[t], jumps, t);
      moments[t] /= 4 * kPi;
    }
  });
  return moments;
}

}  // namespace ambient
