#pragma once

#include "preprocess/added_mass_tables/table_places.h"

namespace ambient {

// Generated: tests/preprocess/added_mass_tables writes table_data.cpp.

/// Revision of the tables, part of a fluid body's provenance. Raise it with every change.
constexpr int kTableRevision = 1;

/// Rotation and logarithm of translation, over the scales of BoxAxis.
struct BoxTable {
  ChebyshevSeries rotation, translation;
};
const BoxTable& boxTable();

/// Entries over the scales of RoundPlace; of v_z and v_x the logarithms. A series without rows is
/// 0.
struct RoundTable {
  ChebyshevSeries v_z, v_x, w_y, coupling;
};
const RoundTable& cylinderTable();
const RoundTable& capsuleTable();
const RoundTable& coneTable();

}  // namespace ambient
