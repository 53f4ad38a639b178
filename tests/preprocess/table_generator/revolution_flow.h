#pragma once

#include "preprocess/added_mass_tables/revolution_inertia.h"
#include "tests/preprocess/table_generator/meridian.h"

namespace ambient {

/// Solves Green's identity on the meridian, by wave number around the axis. Panels of Gauss points
/// are graded by halving towards the ends of pieces, so that edges keep the accuracy.
/// docs/theory.md eq. (75). Relative error below 2e-5, at blunt edges 1e-6; cost: about a second of
/// one core.
/// @pre the pieces are connected, from axis to axis
RevolutionInertia solveRevolutionFlow(const Meridian& meridian);

}  // namespace ambient
