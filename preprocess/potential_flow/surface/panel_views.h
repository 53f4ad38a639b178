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

// The kernel, once per instruction set.
void viewPanelBaseline(const PanelNumbers& panel, const PanelPoints& points, int count,
                       PanelViews& views);
void viewPanelAvx2(const PanelNumbers& panel, const PanelPoints& points, int count,
                   PanelViews& views);
void viewPanelAvx512(const PanelNumbers& panel, const PanelPoints& points, int count,
                     PanelViews& views);

/// Computes the views of eight or sixteen points, each as if it were alone.
/// @pre `count` is 8 or 16, and so many points are finite
extern const Kernels<decltype(&viewPanelBaseline)> kViewPanel;

}  // namespace ambient
