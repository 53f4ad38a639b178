#pragma once

#include <string>
#include <vector>

#include "preprocess/builder/fluid_body_builder.h"

namespace ambient {

/// Adds the tanks and openings that a user has given to the holds of a vessel. A tank is a hold
/// without openings, in the walls or in a cavity of the body; an opening belongs to the hold whose
/// wall is nearest. Returns a line for each hold that has become another one.
/// @param closed mesh of the vessel, or of the body without holds
/// @param settings given and found holds, cavities; takes what is new
/// @throws std::runtime_error in one line that names the file of the tank, if it is no closed body,
/// is not inside the vessel or reaches into another hold; or the number of the opening, if it has
/// no area or direction, or no hold is near
std::vector<std::string> takeGivenHolds(const TriangleMesh& closed, BuildSettings& settings);

/// Text of the tanks and openings for Provenance::settings, with hashes of the files; begins with
/// ", " where there are some.
std::string givenHoldsText(const HoldSearch& search);

}  // namespace ambient
