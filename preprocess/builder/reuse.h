#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// The fluid body of a file, if it can be read, has that name, and was made by the same program,
/// version and revision of the solver from the same source with the same settings, so that building
/// it anew would give the same.
std::optional<FluidBody> readIfSame(const std::filesystem::path& file, const std::string& name,
                                    const Provenance& provenance);

/// Makes sure that nothing is lost when a fluid body is written to a file.
/// @throws std::runtime_error in one line that names the file, if it holds something and does not
/// begin as a .ambient file.
void requireReplaceable(const std::filesystem::path& file);

}  // namespace ambient
