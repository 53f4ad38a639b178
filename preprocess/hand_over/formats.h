#pragma once

#include <string>

#include "preprocess/hand_over/exported_body.h"
#include "preprocess/hand_over/handed_body.h"

namespace ambient {

// Each of these makes a file of one format. Matrices are symmetric to rounding.

/// SDFormat 1.10: a model of one link with mass and fluid_added_mass. The link's frame is F.
ExportedBody makeSdf(const HandedBody& body);

/// MJCF: a free body with mass and the ellipsoid that comes nearest to its added mass. The report
/// compares the two.
ExportedBody makeMjcf(const HandedBody& body);

/// JSON: Fossen's matrices in SNAME's body axes, origin at that of F.
ExportedBody makeFossen(const HandedBody& body);

}  // namespace ambient
