#pragma once

#include <optional>
#include <string>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

// Added mass per unit density of simple shapes [m^3 to m^5], rotation first, about the origin of
// the shape as JSON has it (centre of a box, half the height of a round one, whose axis is z), from
// tables that were made by tests/preprocess/added_mass_tables; none outside of their range,
// kLargestRatio and kLargestRounding. Error against the limit of fine meshes, relative to the
// largest entry of the block: docs/accuracy.md. What symmetry forbids is exactly zero. Cost: some
// microseconds.
// @pre sizes positive and finite

/// Name of the tables in the provenance of a fluid body: "added mass tables 1".
std::string addedMassTablesName();

/// Added mass of a box of half sizes [m].
std::optional<Matrix6> boxAddedMass(const Vector3& half_sizes);
std::optional<Matrix6> cylinderAddedMass(double radius, double height);
/// Height of the cylindrical part.
std::optional<Matrix6> capsuleAddedMass(double radius, double height);
/// Apex at +height/2; with all points within `rounding` of the cone.
std::optional<Matrix6> coneAddedMass(double radius, double height, double rounding = 0);

}  // namespace ambient
