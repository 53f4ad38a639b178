#pragma once

#include <string>

#include "tests/preprocess/table_generator/table_samples.h"

namespace ambient {

/// Markdown: errors of a table over random shapes, one line each and the largest. Columns: table
/// against its own solver, and default builds against the table. Relative to the largest entry of
/// the block. Deterministic.
std::string checkTable(TableShape::Kind kind, int shapes, int seed);

}  // namespace ambient
