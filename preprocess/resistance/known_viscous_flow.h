#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {

// What is known of simple shapes in a fluid with viscosity, without a mesh, about the origin of the
// shape as JSON has it (centre of a box, half the height of a round one, whose axis is z). R of
// ellipsoids in closed form, of others from tables within 1 % up to kLargestRatio, beyond unknown.
// Layers of ellipsoids are those of a table within 2 % (k_B, k_1, f_B 7 %), of cylinders across
// those of a circle in plane flow, of capsules interpolated; beyond 20 : 1 (capsules 10) those of
// the last one. Edges make all of the base of boxes, cones and cylinders along. Cost: some
// microseconds.
// @pre sizes positive and finite [m]; `added_mass` is that of the shape

KnownViscousFlow ellipsoidViscousFlow(const Vector3& semi_axes, const Matrix6& added_mass);
KnownViscousFlow boxViscousFlow(const Vector3& half_sizes);
KnownViscousFlow cylinderViscousFlow(double radius, double height, const Matrix6& added_mass);
/// Height of the cylindrical part.
KnownViscousFlow capsuleViscousFlow(double radius, double height, const Matrix6& added_mass);
/// Apex at +height/2.
KnownViscousFlow coneViscousFlow(double radius, double height);

}  // namespace ambient
