#pragma once

#include "bullet_ambient/base/instruction_set.h"

namespace ambient {

constexpr int kMostPanelPoints = 16;

/// A panel in plain numbers, for sources that are compiled once per instruction set.
struct PanelNumbers {
  double corner[3][3];       ///< by corner and axis
  double edge_normal[3][3];  ///< by edge and axis; Panel::edge_normal
  double edge_length[3];
  double normal[3];
  double area;
};

/// Points that see a panel, by axis and point.
struct PanelPoints {
  alignas(64) double at[3][kMostPanelPoints];
};

/// A panel seen from points: signed height over its plane and signed solid angle, and of each edge
/// the distance in the panel's plane (positive inside) and int 1/|x - y| dl.
struct PanelViews {
  alignas(64) double height[kMostPanelPoints];
  alignas(64) double solid_angle[kMostPanelPoints];
  alignas(64) double edge_distance[3][kMostPanelPoints];
  alignas(64) double edge_potential[3][kMostPanelPoints];
};

/// Symmetric tensors at points: xx, yy, zz, xy, xz, yz.
struct PanelTensors {
  alignas(64) double at[6][kMostPanelPoints];
};

/// Potentials at points: those of six jumps on panels, and that of a jump of 1, the solid angle.
struct PanelPotentials {
  alignas(64) double at[7][kMostPanelPoints];
};

/// Six points on a panel with weights that sum up to 1, and hat functions there.
struct PanelNodes {
  static constexpr int kCount = 6;
  double place[kCount][3], hat[kCount][3], weight[kCount];
};

/// Values of the six jumps and of the jump of 1 at the corners of a panel.
using CornerJumps = double[3][7];

// The kernels, once per instruction set. Each point is computed as if it were alone.
// @pre `count` is 8 or 16, and so many points are finite
#define AMBIENT_PANEL_KERNELS(set)                                                             \
  void viewPanel##set(const PanelNumbers& panel, const PanelPoints& points, int count,         \
                      PanelViews& views);                                                      \
  void viewStokeslets##set(const PanelNumbers& panel, const PanelPoints& points, int count,    \
                           PanelTensors& tensors);                                             \
  void addDoubleLayer##set(const PanelNumbers& panel, const CornerJumps& jumps,                \
                           const PanelPoints& points, int count, PanelPotentials& potentials); \
  void addPointDipoles##set(const PanelNumbers& panel, const PanelNodes& nodes,                \
                            const CornerJumps& jumps, const PanelPoints& points, int count,    \
                            PanelPotentials& potentials);                                      \
  double meanInverseDistance##set(const PanelNodes& a, const PanelNodes& b);
AMBIENT_PANEL_KERNELS(Baseline)
AMBIENT_PANEL_KERNELS(Avx2)
AMBIENT_PANEL_KERNELS(Avx512)

/// Computes the views.
extern const Kernels<decltype(&viewPanelBaseline)> kViewPanel;
/// Computes int (I/r + r r^T/r^3) dy over the panel; docs/theory.md eq. (94).
extern const Kernels<decltype(&viewStokesletsBaseline)> kViewStokeslets;
/// Adds the potentials int h_b n.(x - y)/r^3 dy of linear jumps, in closed form.
extern const Kernels<decltype(&addDoubleLayerBaseline)> kAddDoubleLayer;
/// Adds the same by points of the panel, for panels a little apart.
extern const Kernels<decltype(&addPointDipolesBaseline)> kAddPointDipoles;
/// Computes the mean of 1/r between the points of two panels.
extern const Kernels<decltype(&meanInverseDistanceBaseline)> kMeanInverseDistance;

}  // namespace ambient
