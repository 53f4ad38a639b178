#pragma once

#include <optional>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Returns one JSON object about a fluid body; numbers have all digits that the same bits need.
/// `seconds`: duration of the build, if it was built just now.
std::string reportJson(const FluidBody& body, std::optional<double> seconds);

/// Returns a table of the same facts for people, headed by the file's name.
std::string reportTable(const FluidBody& body, const std::string& file);

}  // namespace ambient
