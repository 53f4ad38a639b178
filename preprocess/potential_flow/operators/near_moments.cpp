#include "preprocess/potential_flow/operators/near_moments.h"

#include <algorithm>
#include <cmath>

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
  return j;
}

/// int_S h_b n.(x - y)/r^3 dy by points at all nodes x of a panel, for panels a little apart.
Eigen::Matrix<double, 6, 3> computeDoubleLayerByPoints(const Panel& source,
                                                       const NodePotentials<6>& nodes) {
  using Array6 = Eigen::Array<double, 6, 1>;
  Array6 x, y, z;
  for (int k = 0; k < 6; ++k) {
    const Vector3d& node = nodes.node(k);
    x[k] = node.x(), y[k] = node.y(), z[k] = node.z();
  }
  Eigen::Matrix<double, 6, 3> weights = Eigen::Matrix<double, 6, 3>::Zero();
  for (const TriangleNode& node : kTriangleRule6) {
    const Vector3d point = source.at(node.barycentric);
    const Array6 square =
        (x - point.x()).square() + (y - point.y()).square() + (z - point.z()).square();
    const Array6 kernel = node.weight / (square * square.sqrt());
    for (int b = 0; b < 3; ++b) weights.col(b).array() += node.barycentric[b] * kernel;
  }
  const Vector3d &n = source.normal, &c = source.centroid;
  const Array6 height = n.x() * (x - c.x()) + n.y() * (y - c.y()) + n.z() * (z - c.z());
  for (int b = 0; b < 3; ++b) weights.col(b).array() *= source.area * height;
  return weights;
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
    const Panel& source = surface.panels[entry.panel];
    const Matrix36& jump = jumps[entry.panel].corner;
    switch (entry.kind) {
      case PairKind::Same:
        break;  // a flat panel has no double layer on itself
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
        coarse.addAll(computeDoubleLayerByPoints(source, coarse), jump);
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
