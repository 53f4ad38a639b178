#pragma once

// Saved states of a world and its fluid, as bytes.

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

class btDynamicsWorld;

AMBIENT_BEGIN

class AmbientBodies;

/// Saves rigid bodies and multibodies, their fluids, contacts and joints, between two steps.
/// Changes nothing. Not included: soft bodies, vehicles, the time that stepSimulation() keeps when
/// it interpolates, and what only the program sets (shapes, parameters of joints and motors,
/// filters, additional damping).
WorldState saveState(const btDynamicsWorld& world, const AmbientBodies& members);

/// Restores a saved state; docs/bullet_step.md says when the world then continues bit for bit. The
/// world must have the same bodies, multibodies and joints in the same order: it is the same one,
/// or was built by the same code, or loaded from a file. Adds and removes bodies as needed. Runs
/// Bullet's collision detection once, with its callbacks, to make contact manifolds.
/// @throws std::invalid_argument if the numbers of bodies, links or joints differ, a value is
/// invalid, a fluid body is missing or a medium is not physical; the world is then unchanged.
void restoreState(const WorldState& state, btDynamicsWorld& world, AmbientBodies& members);

/// Function that finds a fluid body by name; null: none of that name. Saved bytes hold names and
/// content hashes of fluid bodies, not the fluid bodies themselves.
using FluidBodyLookup = std::function<std::shared_ptr<const FluidBody>(const std::string& name)>;

/// Converts a saved state to bytes: little-endian, with version, precision and checksum. The same
/// state gives the same bytes. FlowSettings::own_law and FlightSettings::own_flight, functions, are
/// not included: set them in the result of decodeState(). Foils, FlowSettings::foils, are not
/// either: a body that has some keeps them, at the angles to which it has turned them.
/// @throws std::runtime_error if two fluid bodies of one name have different contents.
std::string encodeState(const WorldState& state);

/// Converts bytes of encodeState() back to the same state, bit for bit; messages name `source`.
/// @throws std::runtime_error with one sentence if the bytes are foreign, cut short, damaged, of a
/// newer version or of the other precision of Bullet, or if a fluid body is not found or not the
/// one that was saved.
WorldState decodeState(std::string_view bytes, const std::string& source,
                       const FluidBodyLookup& lookup);

AMBIENT_END
