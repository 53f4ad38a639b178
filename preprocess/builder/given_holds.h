#pragma once

#include <string>
#include <vector>

#include "preprocess/mesh/holds/hold_search.h"

namespace ambient {

/// Holds of a body, to which given ones are added, and the meshes that change with them.
struct HoldsOfBody {
  std::vector<Hold>& holds;
  TriangleMesh& walls;     ///< with holds: the faces of walls alone
  TriangleMesh& cavities;  ///< closed surfaces inside that nothing fills
};

/// Adds the tanks and openings that a user has given to the holds of a vessel. A tank is a hold
/// without openings, in the walls or in a cavity of the body; an opening belongs to the hold whose
/// wall is nearest. Returns a line for each tank.
/// @param closed mesh of the vessel, or of the body without holds
/// @param given tanks and openings
/// @param source begins lines and messages
/// @param body takes what is new
/// @throws std::runtime_error in one line that names the file of the tank, if it is no closed body,
/// is not inside the vessel or reaches into another hold; or the number of the opening, if it has
/// no area or direction, or no hold is near
std::vector<std::string> addGivenHolds(const TriangleMesh& closed, const HoldSearch& given,
                                       const std::string& source, const HoldsOfBody& body);

/// Text of the tanks and openings for Provenance::settings, with hashes of the files; begins with
/// ", " where there are some.
std::string givenHoldsText(const HoldSearch& given);

}  // namespace ambient
