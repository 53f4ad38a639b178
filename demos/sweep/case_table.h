#pragma once

#include <filesystem>

#include "demos/sweep/result_table.h"

namespace ambient {

/// Table of the results of all finished cases, in the order of the file, one row per body.
/// Columns: index and key of the case, one per path of an override, resultColumns(). The table does
/// not depend on which process ran which case.
/// @throws std::runtime_error if the file cannot be read, or `out` is no folder.
ResultTable collectCases(const std::filesystem::path& cases, const std::filesystem::path& out);

}  // namespace ambient
