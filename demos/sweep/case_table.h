#pragma once

#include <filesystem>

#include "demos/sweep/result_table.h"

namespace ambient {

/// The results of all cases of a file that are done, in the order of the file, one row per body:
/// index and key of the case, its overrides by their paths, resultColumns(). Whichever process ran
/// which case, the table is the same.
/// @throws std::runtime_error if the file cannot be read, or `out` is no folder.
ResultTable collectCases(const std::filesystem::path& cases, const std::filesystem::path& out);

}  // namespace ambient
