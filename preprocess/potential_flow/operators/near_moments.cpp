#include "preprocess/potential_flow/operators/near_moments.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/base/parallel_for.h"

namespace ambient {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

PanelJump jumpOn(const PanelSurface& surface, const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                 Index t) {
  PanelJump j;
  j.gradient.setZero();
  for (int a = 0; a < 3; ++a) {
    j.corner.row(a) = jump.row(surface.triangles(a, t));
    j.gradient += surface.panels[t].hatGradient(a) * j.corner.row(a);
  }
  j.mean = j.corner.colwise().mean();
  for (int a = 0; a < 3; ++a) {
    for (int field = 0; field < 6; ++field) j.of_kernel[a][field] = j.corner(a, field);
    j.of_kernel[a][6] = 1;
  }
  return j;
}

/// Whether a panel lies in the plane of another one, as on a flat side: neither sees the other one
/// across.
bool areInOnePlane(const Panel& panel, const Panel& other) {
  constexpr double kRounding = 1e-12;  // of the size of the surface, which is 1
  for (const Vector3d& corner : panel.corner)
    if (std::abs(other.normal.dot(corner - other.centroid)) > kRounding) return false;
  return true;
}

}  // namespace

std::vector<PanelJump> makePanelJumps(const PanelSurface& surface,
                                      const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump) {
  std::vector<PanelJump> jumps(surface.panelCount());
  for (Index t = 0; t < surface.panelCount(); ++t) jumps[t] = jumpOn(surface, jump, t);
  return jumps;
}

Matrix36 computeNearMoments(const PanelSurface& surface, const std::vector<NearPanels::Entry>& near,
                            const std::vector<PanelJump>& jumps, Index t) {
  NodePotentials<6> coarse(surface.panels[t], kTriangleRule6);
  NodePotentials<16> fine(surface.panels[t], kTriangleRule16);
  for (const NearPanels::Entry& entry : near) {
    if (areInOnePlane(surface.panels[t], surface.panels[entry.panel])) continue;  // itself, too
    const PanelNumbers& source = surface.numbers[entry.panel];
    const CornerJumps& jump = jumps[entry.panel].of_kernel;
    switch (entry.kind) {
      case PairKind::Same:
      case PairKind::SharedEdge:
      case PairKind::SharedVertex:
      case PairKind::Near:
        fine.add(source, jump);
        break;
      case PairKind::Close:
        coarse.add(source, jump);
        break;
      case PairKind::Middle:
      case PairKind::Far:
        coarse.addByPoints(source, surface.nodes[entry.panel], jump);
        break;
    }
  }
  return fine.moments(surface.panels[t], jumps[t].corner) +
         coarse.moments(surface.panels[t], jumps[t].corner);
}

NearPanels findNearPanels(const PanelSurface& surface, int threads) {
  NearPanels near;
  const Eigen::Index n = surface.panelCount();
  near.of_panel.resize(n);
  const PanelArrays& a = surface.arrays;
  parallelFor(threads, n, [&](std::ptrdiff_t t) {
    constexpr double kReach = kFarLimit * (1 + 1e-9);  // classifyPair() decides at the limit
    const Eigen::Array<bool, Eigen::Dynamic, 1> may_be_near =
        (a.x - a.x[t]).square() + (a.y - a.y[t]).square() + (a.z - a.z[t]).square() <=
        (kReach * (a.radius + a.radius[t])).square();
    for (Eigen::Index s = 0; s < n; ++s) {
      if (!may_be_near[s]) continue;
      const PairKind kind = classifyPair(surface, t, s);
      if (kind == PairKind::Far) continue;
      const double integral = s >= t ? computePairIntegral(surface, t, s, kind) : 0;
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

namespace {

using Eigen::ArrayXd;

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
