#pragma once

#include "preprocess/added_mass_tables/revolution_inertia.h"
#include "preprocess/table_generator/meridian.h"

namespace ambient {

/// Solves Green's identity on the meridian, by wave number around the axis: panels of Gauss points,
/// halved again and again towards the ends of the pieces, so that edges cost no accuracy.
/// docs/theory.md eq. (75). Relative error below 2e-5, at blunt edges 1e-6; about a second of one
/// core.
/// @pre the pieces are connected, from axis to axis
RevolutionInertia solveRevolutionFlow(const Meridian& meridian);

}  // namespace ambient
