#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// How sharp the surface is at each face, from round (0, all of a sphere) to flat, hollow or edged
/// (1): docs/theory.md eq. (45). F entries, rounded to single precision, for the faces in their
/// order: the triangles of `surface`, and their backs in turn if the body is a sheet. Scale
/// invariant. Cost O(F).
/// @throws std::invalid_argument in one sentence, if the faces are not these triangles.
std::vector<double> computeSharpness(const FluidBody& body);

/// The faces to sum the form law over: those of the body with their sharpness, but that flat sides
/// with few corners become 16 points per four corners, by Gauss's rule. The law has no jump at the
/// edge of the wake, so that fewer points do, docs/accuracy.md. Cost O(F).
/// @throws std::invalid_argument as computeSharpness().
FaceTable formLawFaces(const FluidBody& body);

}  // namespace ambient
