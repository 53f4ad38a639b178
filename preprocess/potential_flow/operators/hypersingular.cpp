#include "preprocess/potential_flow/operators/hypersingular.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/base/parallel_for.h"

namespace ambient {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::Vector3d;

constexpr Index kPanelsAtOnce = 128;  // held in memory between the two passes
constexpr Index kRowBlock = 64;

/// sum over s of I(t, s) curl h_j on s, for every unknown j (U x 3).
void gatherCurls(const PanelSurface& surface, const Unknowns& unknowns, const ArrayXd& row,
                 Eigen::MatrixX3d& curls) {
  curls.setZero();
  for (Index s = 0; s < surface.panelCount(); ++s)
    for (int a = 0; a < 3; ++a) {
      const int j = unknowns.of_vertex[surface.triangles(a, s)];
      if (j >= 0) curls.row(j) += row[s] * surface.panels[s].hatCurl(a).transpose();
    }
}

}  // namespace

Unknowns numberUnknowns(const PanelSurface& surface) {
  Unknowns unknowns;
  for (Index v = 0; v < surface.vertexCount(); ++v) {
    const bool free = surface.component[v] >= 0 && !surface.boundary_vertex[v];
    unknowns.of_vertex.push_back(free ? unknowns.count++ : -1);
  }
  return unknowns;
}

Eigen::MatrixXd assembleHypersingular(const PanelSurface& surface, const Unknowns& unknowns,
                                      const NearPanels& near, int threads) {
  const Index panels = surface.panelCount(), size = unknowns.count;
  AMBIENT_ASSERT(near.of_panel.size() == static_cast<std::size_t>(panels));
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(size, size);
  std::vector<Eigen::MatrixX3d> curls(kPanelsAtOnce, Eigen::MatrixX3d(size, 3));
  for (Index first = 0; first < panels; first += kPanelsAtOnce) {
    const Index count = std::min(kPanelsAtOnce, panels - first);
    parallelFor(threads, count, [&](Index k) {
      ArrayXd row(panels);
      computeFarPairIntegrals(surface.arrays, first + k, 0, row);
      for (const NearPanels::Entry& entry : near.of_panel[first + k])
        row[entry.panel] = entry.integral;
      gatherCurls(surface, unknowns, row, curls[k]);
    });
    const Index row_blocks = (size + kRowBlock - 1) / kRowBlock;
    parallelFor(threads, row_blocks, [&](Index block) {
      const Index row = block * kRowBlock, height = std::min(kRowBlock, size - row);
      for (Index k = 0; k < count; ++k)
        for (int a = 0; a < 3; ++a) {
          const Index i = unknowns.of_vertex[surface.triangles(a, first + k)];
          if (i < 0 || i >= row + height) continue;
          const Vector3d curl = surface.panels[first + k].hatCurl(a) / (4 * kPi);
          W.col(i).segment(row, height) += curls[k].middleRows(row, height) * curl;
        }
    });
  }
  return W;
}

void fillKernel(const PanelSurface& surface, const Unknowns& unknowns, Eigen::MatrixXd& W) {
  AMBIENT_ASSERT(W.rows() == W.cols() && W.rows() >= unknowns.count);
  std::vector<bool> open(surface.component_count, false);
  std::vector<std::vector<int>> members(surface.component_count);
  for (Index v = 0; v < surface.vertexCount(); ++v) {
    const int component = surface.component[v], unknown = unknowns.of_vertex[v];
    if (component < 0) continue;
    if (unknown >= 0) members[component].push_back(unknown);
    open[component] = open[component] || unknown < 0;
  }
  for (int c = 0; c < surface.component_count; ++c) {
    if (open[c]) continue;
    double trace = 0;
    for (int i : members[c]) trace += W(i, i);
    const auto count = static_cast<double>(members[c].size());
    const double s = trace / (count * count);
    for (int i : members[c])
      for (int j : members[c]) W(i, j) += s;
  }
}

Eigen::Matrix<double, Eigen::Dynamic, 6> assembleNormalVelocity(const PanelSurface& surface,
                                                                const Unknowns& unknowns) {
  Eigen::Matrix<double, Eigen::Dynamic, 6> B(unknowns.count, 6);
  B.setZero();
  for (Index t = 0; t < surface.panelCount(); ++t) {
    const Panel& p = surface.panels[t];
    for (int a = 0; a < 3; ++a) {
      const Index i = unknowns.of_vertex[surface.triangles(a, t)];
      if (i < 0) continue;
      const Vector3d first_moment = p.area / 12 * (3 * p.centroid + p.corner[a]);
      B.row(i).head<3>() += first_moment.cross(p.normal).transpose();
      B.row(i).tail<3>() += p.area / 3 * p.normal.transpose();
    }
  }
  return B;
}

}  // namespace ambient
