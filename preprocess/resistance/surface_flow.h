#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A closed surface, cut along its sharp edges: convex ones with more than 50 degrees between the
/// normals, as those of E, docs/theory.md eq. (45c). Each side of a sharp edge has vertices of its
/// own. Lengths are those of the mesh over D_A = sqrt(area/pi).
struct CutSurface {
  TriangleMesh mesh;
  std::vector<int> source;  ///< of each vertex: its number in the mesh that was cut
  std::vector<std::vector<int>>
      copies;                          ///< of each vertex on a sharp edge: the other vertices there
  std::vector<std::vector<int>> fans;  ///< of each vertex: its triangles
  std::vector<Eigen::Vector3d> normals;  ///< unit, at vertices
  std::vector<double> area;              ///< of triangles
  std::vector<Eigen::Vector3d> triangle_normals;
};

/// Cuts a mesh along its sharp edges. Vertices without a triangle are left out. Cost O(T log T).
/// @pre closed and manifold
CutSurface cutAtSharpEdges(const TriangleMesh& mesh);

/// Flow of an ideal fluid past a body at a vertex of its surface, along it: total, relative to the
/// body, for unit speed of the body. Lengths over D_A.
struct VertexFlow {
  double potential = 0;                                ///< grows downstream
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< its gradient along the surface
  Eigen::Matrix3d stretching =
      Eigen::Matrix3d::Zero();  ///< its second derivatives along the surface, symmetric

  VertexFlow& add(double factor, const VertexFlow& other);
};

/// Flows past the body for unit velocities along the axes of the mesh, by axis and vertex of the
/// cut surface.
using UnitFlows = std::array<std::vector<VertexFlow>, 3>;

/// Differentiates potentials on the surface: polynomials of degree 3 (2 at sharp edges and where
/// neighbours are few) in the plane of the normal, fitted to two rings of neighbours. There second
/// derivatives are those along the surface, however it bends. Errors: second order in the size of
/// triangles.
/// @param potential V x 3 of the mesh that was cut [m]: of the fluid, for unit velocities along the
/// axes, as the right half of PotentialFlow::potential
/// @param length D_A [m]
UnitFlows differentiateFlow(const CutSurface& surface,
                            const Eigen::Matrix<double, Eigen::Dynamic, 3>& potential,
                            double length);

/// Flows past an ellipsoid in closed form, at the vertices of its mesh: potential (1 + k_j/V) times
/// that of the stream (Lamb, art. 114).
/// @param semi_axes over D_A
UnitFlows ellipsoidFlow(const CutSurface& surface, const Eigen::Vector3d& semi_axes);

}  // namespace ambient
