#pragma once

#include "preprocess/added_mass_tables/chebyshev_series.h"

namespace ambient {

// Generated: tests/preprocess/table_generator writes table_data.cpp.

/// Raised with every change of the tables; part of a fluid body's provenance.
constexpr int kTableRevision = 1;

/// Over the scales of BoxAxis; of the translation the logarithm.
struct BoxTable {
  ChebyshevSeries rotation, translation;
};
const BoxTable& boxTable();

/// Over the scales of RoundPlace, of the translations the logarithms; without rows where it is 0.
struct RoundTable {
  ChebyshevSeries v_z, v_x, w_y, coupling;
};
const RoundTable& cylinderTable();
const RoundTable& capsuleTable();
const RoundTable& coneTable();

}  // namespace ambient
