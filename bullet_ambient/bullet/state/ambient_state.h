#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

AMBIENT_BEGIN

/// The fluid of a body or a link.
AmbientState saveAmbient(const AmbientBody& ambient);

/// Saves the fluids of the links of a tree and its memory, without its motion.
void saveFluids(const AmbientTree& tree, MultiBodyState& state);

/// A body in its fluid, as saved; `body`: of its mass and inertia, to which `ambient.body` points.
/// @throws std::invalid_argument if the fluid body is missing or a number is not physical.
AmbientBody makeAmbient(const AmbientState& saved, btRigidBody& body, AmbientBodies& registered);

/// The links in fluid of a multibody of this state, as saved. Changes nothing.
/// @throws std::invalid_argument as makeAmbient(), or if there is no such link.
std::vector<std::unique_ptr<AmbientLink>> makeLinks(const MultiBodyState& state,
                                                    AmbientBodies& registered);

/// Attaches the links of makeLinks(), in place of those that are attached.
/// @pre the multibody is of this state
void insertLinks(const MultiBodyState& state, std::vector<std::unique_ptr<AmbientLink>> links,
                 btMultiBodyDynamicsWorld& world, btMultiBody& body, AmbientBodies& registered);

AMBIENT_END
