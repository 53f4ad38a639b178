#pragma once

#include <string>

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/world_state.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// What no world can have been in, in the words that follow "the saved state", with body or contact
/// and value; empty if there is nothing. Of a fluid only what its flight remembers: makeBodyModel()
/// tells the rest.
std::string findFault(const WorldState& state);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
