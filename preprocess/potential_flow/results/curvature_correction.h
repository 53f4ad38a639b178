#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/potential_flow/surface/face_bulges.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {

/// Change of a body's volume and added mass if its flat triangles bulge to the smooth surface that
/// they approximate; first order in the height, docs/theory.md eq. (11a). Zero without bulges.
struct CurvatureCorrection {
  Matrix6 added_mass = Matrix6::Zero();  ///< about the mesh's origin, per unit density
  double volume = 0;                     ///< [m^3]
};

/// Computes the correction.
/// @param mesh mesh whose triangles approximate a smooth surface
/// @param bulges estimateBulges() of the mesh
/// @param panels the same flat surface, divided
/// @param potential V x 6 of the panels' vertices, outside, of unit motions about the mesh's origin
CurvatureCorrection computeCurvatureCorrection(
    const TriangleMesh& mesh, const std::vector<FaceBulge>& bulges, const DividedSurface& panels,
    const Eigen::Matrix<double, Eigen::Dynamic, 6>& potential);

}  // namespace ambient
