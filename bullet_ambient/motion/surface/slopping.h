#pragma once

#include "bullet_ambient/motion/surface/flotation.h"

namespace ambient {

/// Finds the waves of the water in the holds where they may reach the openings to the sea,
/// docs/theory.md eq. (154a). Cost: the corners of the openings of holds with waves; where one is
/// reached, 50 ns for each of its edges. Allocates nothing.
/// @param at the water at the place of the body
/// @param changes of its openings; null: none
/// @param states one of each hold
/// @param waves with a place for each opening and hold; takes the waves, of which none is lost
void findWavesInside(const WaterAt& at, const OpeningChanges* changes, const Sloshing* states,
                     WavesInside& waves) noexcept;

/// Takes from the sloshing the energy of the water that has slopped over, eq. (154b). Returns it
/// [J]. Parameters are those of findWavesInside(); the place may have been left since.
double loseSlopped(double weight, const WavesInside& waves, Sloshing* states) noexcept;

}  // namespace ambient
