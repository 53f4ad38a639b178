#include "preprocess/potential_flow/surface/panel.h"

#include <algorithm>
#include <cstddef>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/potential_flow/surface/panel_views.h"

namespace ambient {

const Kernels<decltype(&viewPanelBaseline)> kViewPanel{AMBIENT_KERNELS(viewPanel)};
const Kernels<decltype(&viewStokesletsBaseline)> kViewStokeslets{AMBIENT_KERNELS(viewStokeslets)};
const Kernels<decltype(&addDoubleLayerBaseline)> kAddDoubleLayer{AMBIENT_KERNELS(addDoubleLayer)};
const Kernels<decltype(&addPointDipolesBaseline)> kAddPointDipoles{
    AMBIENT_KERNELS(addPointDipoles)};
const Kernels<decltype(&meanInverseDistanceBaseline)> kMeanInverseDistance{
    AMBIENT_KERNELS(meanInverseDistance)};

PanelNumbers numbersOf(const Panel& panel) {
  PanelNumbers numbers;
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      numbers.corner[k][axis] = panel.corner[k][axis];
      numbers.edge_normal[k][axis] = panel.edge_normal[k][axis];
    }
    numbers.edge_length[k] = panel.edge_length[k];
    numbers.normal[k] = panel.normal[k];
  }
  numbers.area = panel.area;
  return numbers;
}

PanelNodes nodesOf(const Panel& panel) {
  PanelNodes nodes;
  for (int i = 0; i < PanelNodes::kCount; ++i) {
    const TriangleNode& node = kTriangleRule6[static_cast<std::size_t>(i)];
    const Eigen::Vector3d place = panel.at(node.barycentric);
    std::copy(place.begin(), place.end(), nodes.place[i]);
    std::copy(node.barycentric.begin(), node.barycentric.end(), nodes.hat[i]);
    nodes.weight[i] = node.weight;
  }
  return nodes;
}

Panel makePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  Panel p;
  p.corner = {a, b, c};
  const Eigen::Vector3d twice_area = (b - a).cross(c - a);
  p.area = twice_area.norm() / 2;
  p.normal = twice_area / (2 * p.area);
  p.centroid = (a + b + c) / 3;
  for (int k = 0; k < 3; ++k) {
    p.edge[k] = p.corner[(k + 1) % 3] - p.corner[k];
    p.edge_length[k] = p.edge[k].norm();
    p.edge_normal[k] = p.edge[k].cross(p.normal) / p.edge_length[k];
    p.radius = std::max(p.radius, (p.corner[k] - p.centroid).norm());
  }
  return p;
}

PanelViews viewPanel(const Panel& panel, const Eigen::Vector3d* points, std::size_t count) {
  static const auto view = kViewPanel.fastest();
  AMBIENT_ASSERT(count > 0 && count <= kMostPanelPoints);
  const std::size_t computed = count <= 8 ? 8 : kMostPanelPoints;
  PanelPoints of_kernel;
  for (std::size_t k = 0; k < computed; ++k)
    for (int axis = 0; axis < 3; ++axis)
      of_kernel.at[axis][k] = points[std::min(k, count - 1)][axis];
  PanelViews views;
  view(numbersOf(panel), of_kernel, static_cast<int>(computed), views);
  return views;
}

void computeNewtonPotentials(const Panel& panel, const Eigen::Vector3d* points, std::size_t count,
                             double* potentials) {
  const PanelViews v = viewPanel(panel, points, count);
  for (std::size_t i = 0; i < count; ++i) {
    potentials[i] = -v.height[i] * v.solid_angle[i];
    for (int k = 0; k < 3; ++k) potentials[i] += v.edge_distance[k][i] * v.edge_potential[k][i];
  }
}

}  // namespace ambient
