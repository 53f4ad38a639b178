#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

AMBIENT_BEGIN

/// Saves the fluid of a body or link.
AmbientState saveAmbient(const AmbientBody& ambient, const InverseMass& mass);

/// Saves the fluids of the links of a tree, and the memory of its flight; not its motion.
void saveFluids(const AmbientTree& tree, MultiBodyState& state);

/// Makes the entry of a body or link of this mass in its fluid from a saved state.
/// @throws std::invalid_argument if the fluid body is missing or a number is not physical.
AmbientBody makeAmbient(const AmbientState& saved, const InverseMass& mass,
                        AmbientBodies& registered);

/// Gives a body or link at a surface the stand that its last substep has left. Returns false, and
/// changes nothing, if it is at none.
bool floatAgain(AmbientBody& ambient, const RigidState& now, const FluidRegions& regions) noexcept;

/// Makes the entries of all links of a multibody that are in a fluid, from a saved state. Does not
/// add them.
/// @throws std::invalid_argument as makeAmbient(), or if there is no such link.
std::vector<std::unique_ptr<AmbientLink>> makeLinks(const MultiBodyState& state,
                                                    AmbientBodies& registered);

/// Adds the links of makeLinks() in place of the present ones.
/// @pre the multibody is of this state
void insertLinks(const MultiBodyState& state, std::vector<std::unique_ptr<AmbientLink>> links,
                 btMultiBodyDynamicsWorld& world, btMultiBody& body, AmbientBodies& registered);

AMBIENT_END
