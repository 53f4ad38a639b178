#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/world_state.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Fluid bodies are not part of saved bytes, which hold their names and content hashes. This finds
/// them again by name; null if there is none of that name.
using FluidBodyLookup = std::function<std::shared_ptr<const FluidBody>(const std::string& name)>;

/// A saved state as bytes: little-endian, with version, precision and checksum, the same state
/// gives the same bytes.
/// @throws std::runtime_error if two fluid bodies of one name have different contents.
std::string encodeState(const WorldState& state);

/// The state that encodeState() was given, bit for bit; `source` stands for it in messages.
/// @throws std::runtime_error with one sentence if the bytes are foreign, cut short, damaged, of a
/// newer version or of the other precision of Bullet, or if a fluid body is not found or not the
/// one that was saved.
WorldState decodeState(std::string_view bytes, const std::string& source,
                       const FluidBodyLookup& lookup);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
