#include "preprocess/potential_flow/surface/panel.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"

namespace ambient {
namespace {

/// The building blocks of all potentials of a panel seen from x: signed height over its plane,
/// signed solid angle, and per edge the distance P_e (positive inside) and f_e = int_e 1/|x - y|
/// dl.
struct PanelView {
  double height, solid_angle;
  std::array<double, 3> edge_distance, edge_potential;
};

PanelView view(const Panel& panel, const Eigen::Vector3d& x) {
  PanelView v;
  const std::array<Eigen::Vector3d, 3> d = {panel.corner[0] - x, panel.corner[1] - x,
                                            panel.corner[2] - x};
  const std::array<double, 3> r = {d[0].norm(), d[1].norm(), d[2].norm()};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    v.edge_distance[k] = d[k].dot(panel.edge_normal[k]);
    const double sum = r[k] + r[next];
    const double gap = sum - panel.edge_length[k];
    // On the edge itself the logarithm is infinite, but always multiplied by a distance of 0.
    v.edge_potential[k] = gap > 0 ? portable::log((sum + panel.edge_length[k]) / gap) : 0;
  }
  v.height = -d[0].dot(panel.normal);
  const double denominator =
      r[0] * r[1] * r[2] + d[0].dot(d[1]) * r[2] + d[1].dot(d[2]) * r[0] + d[2].dot(d[0]) * r[1];
  // van Oosterom and Strackee 1983, with the triple product -d0.(d1 x d2) = 2 area height.
  v.solid_angle = 2 * portable::atan2(2 * panel.area * v.height, denominator);
  return v;
}

}  // namespace

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

double computeNewtonPotential(const Panel& panel, const Eigen::Vector3d& x) {
  const PanelView v = view(panel, x);
  double potential = -v.height * v.solid_angle;
  for (int k = 0; k < 3; ++k) potential += v.edge_distance[k] * v.edge_potential[k];
  return potential;
}

Eigen::Vector3d computeDoubleLayer(const Panel& panel, const Eigen::Vector3d& x) {
  const PanelView v = view(panel, x);
  Eigen::Vector3d edge_flux = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) edge_flux += panel.edge_normal[k] * v.edge_potential[k];
  const Eigen::Vector3d offset = x - panel.centroid;
  Eigen::Vector3d weights;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d gradient = panel.hatGradient(a);
    weights[a] =
        (1.0 / 3.0 + gradient.dot(offset)) * v.solid_angle - v.height * gradient.dot(edge_flux);
  }
  return weights;
}

}  // namespace ambient
