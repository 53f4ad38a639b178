#include "preprocess/potential_flow/near_moments.h"

#include <cmath>

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

/// int_S h_b n.(x - y)/r^3 dy by points, for panels a little apart.
Vector3d computeDoubleLayerByPoints(const Panel& panel, const Vector3d& x) {
  Vector3d weights = Vector3d::Zero();
  for (const TriangleNode& node : kTriangleRule6) {
    const Vector3d r = x - panel.at(node.barycentric);
    const double square = r.squaredNorm();
    const double kernel = node.weight / (square * std::sqrt(square));
    weights += kernel * Eigen::Map<const Vector3d>(node.barycentric.data());
  }
  return panel.area * panel.normal.dot(x - panel.centroid) * weights;
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
        fine.add(source, jump, computeDoubleLayer);
        break;
      case PairKind::Close:
        coarse.add(source, jump, computeDoubleLayer);
        break;
      case PairKind::Middle:
      case PairKind::Far:
        coarse.add(source, jump, computeDoubleLayerByPoints);
        break;
    }
  }
  return fine.moments(surface.panels[t], jumps[t].corner) +
         coarse.moments(surface.panels[t], jumps[t].corner);
}

}  // namespace ambient
