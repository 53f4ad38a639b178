#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/surface/panel.h"
#include "preprocess/potential_flow/surface/panel_views.h"

namespace ambient {

/// Height of the smooth surface that a mesh approximates above a flat triangle, the quadratic
/// 4 sum_k height[k] h_k h_{k+1} of the hat functions h. height[k] is at the middle of the edge
/// from corner k to corner k + 1 [m], positive into the fluid.
using FaceBulge = std::array<double, 3>;

/// Estimates the heights from the normals at the vertices (Max 1999). Empty if the surface is of
/// several pieces or has a sharp edge, 41 degrees or more between the normals: there a polyhedron
/// may stand for the body's volume in more ways than by its size. Zero where facets do not look
/// like samples of one smooth surface: at the tip of a cone, or next to facets of very different
/// size or turn. Cost O(T log T).
/// @pre the mesh is closed.
std::vector<FaceBulge> estimateBulges(const TriangleMesh& mesh);

/// Whether all triangles but a few stand for a part of a smooth surface. To divide them would
/// resolve the flow around facets that the body does not have.
bool areSmooth(const std::vector<FaceBulge>& bulges);

/// Panel data as a structure of arrays, for the loops over far panels.
struct PanelArrays {
  Eigen::ArrayXd x, y, z;  ///< centroids
  Eigen::ArrayXd normal_x, normal_y, normal_z;
  Eigen::ArrayXd area, radius;
  Eigen::ArrayXd xx, yy, zz, xy, xz, yz;  ///< second central moments per area
};

/// The surface in the units of the solver: moved to its centre and divided by its size.
struct PanelSurface {
  Eigen::Vector3d centre;  ///< centre of volume, for a sheet of area [m]
  double length = 0;       ///< largest distance of a vertex from the centre [m]
  double volume = 0;       ///< in units of length^3; 0 for a sheet
  Eigen::Matrix3Xi triangles;
  std::vector<Panel> panels;
  std::vector<PanelNumbers> numbers;  ///< of the panels, for kernels
  std::vector<PanelNodes> nodes;
  PanelArrays arrays;
  std::vector<int> component;         ///< of each vertex; -1: vertex without a triangle
  std::vector<bool> boundary_vertex;  ///< on an edge with one triangle only
  int component_count = 0;
  int boundary_edge_count = 0;

  Eigen::Index panelCount() const { return triangles.cols(); }
  Eigen::Index vertexCount() const { return static_cast<Eigen::Index>(component.size()); }
};

/// Computes the numbers, nodes and arrays of a surface from its panels.
void fillFromPanels(PanelSurface& surface);

/// Makes panels, moments and connectivity of a mesh, centred and scaled.
/// @throws std::runtime_error for a triangle without area.
PanelSurface makePanelSurface(const TriangleMesh& mesh, bool sheet);

}  // namespace ambient
