#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

class btDynamicsWorld;

AMBIENT_BEGIN

class AmbientBodies;

/// Takes a picture of rigid bodies and multibodies, their fluids, contacts and joints, between two
/// steps. Changes nothing. Not in it: soft bodies, vehicles, the rest of time that stepSimulation()
/// keeps when it interpolates, and what only the program sets (shapes, parameters of joints and
/// motors, filters, additional damping).
WorldState saveState(const btDynamicsWorld& world, const AmbientBodies& members);

/// Puts a world back into a saved state; docs/bullet_step.md says when it then goes on bit for bit.
/// The world has the same bodies, multibodies and joints in the same order: it is the same one, or
/// was built by the same code, or loaded from a file. Attaches and detaches as needed. Runs
/// Bullet's collision detection once, with its callbacks, so that contacts have their places.
/// @throws std::invalid_argument if the numbers of bodies, links or joints differ, a number is none
/// that a world can have, a fluid body is missing or a medium is not physical; the world is then
/// unchanged.
void restoreState(const WorldState& state, btDynamicsWorld& world, AmbientBodies& members);

/// Fluid bodies are not part of saved bytes, which hold their names and content hashes. This finds
/// them again by name; null if there is none of that name.
using FluidBodyLookup = std::function<std::shared_ptr<const FluidBody>(const std::string& name)>;

/// A saved state as bytes: little-endian, with version, precision and checksum, the same state
/// gives the same bytes. A function in FlowSettings::own_law is not in them: set it in what
/// decodeState() returns.
/// @throws std::runtime_error if two fluid bodies of one name have different contents.
std::string encodeState(const WorldState& state);

/// The state that encodeState() was given, bit for bit; `source` stands for it in messages.
/// @throws std::runtime_error with one sentence if the bytes are foreign, cut short, damaged, of a
/// newer version or of the other precision of Bullet, or if a fluid body is not found or not the
/// one that was saved.
WorldState decodeState(std::string_view bytes, const std::string& source,
                       const FluidBodyLookup& lookup);

AMBIENT_END
