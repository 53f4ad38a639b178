#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/results/added_mass_parts.h"

namespace ambient {

/// Carlson's R_D(x, y, z) = 3/2 int_0^inf dt / (sqrt((t + x) (t + y)) (t + z)^(3/2)), to rounding
/// (Carlson 1979). @pre arguments >= 0, the last one and at most one other not 0
double integralD(Vector3 arguments);

/// Computes the added mass of an ellipsoid about its centre, per unit density: the diagonal in its
/// axes, rotation first. Semi-axes [m]. Closed form of Lamb, Hydrodynamics, 6th ed., art. 114 and
/// 115, its integrals by Carlson's duplication (1979), to rounding.
/// @pre semi-axes positive and finite
Vector6 ellipsoidAddedMass(const Vector3& semi_axes);

/// Returns the contributions of the triangles of an ellipsoid's mesh, about its centre. The
/// potentials are linear in translation and bilinear in rotation (art. 114, 115).
std::vector<PanelInertia> ellipsoidPanels(const TriangleMesh& mesh, const Vector3& semi_axes);

/// Estimates the contributions of the triangles of any body, about its centre, from the diagonal K
/// of its added mass. Assumes potentials that are linear in translation, as for an ellipsoid, and
/// bilinear in rotation. The diagonal of the sum is K.
std::vector<PanelInertia> simplePanels(const TriangleMesh& mesh, const Vector6& K);

/// Estimates the parts of a known added mass for a closed mesh whose flow was not solved, by
/// simplePanels(); all about the mesh's origin.
std::vector<AddedMassPart> estimateParts(TriangleMesh mesh, const Matrix6& added_mass);

}  // namespace ambient
