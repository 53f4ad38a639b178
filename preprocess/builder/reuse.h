#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Reads a fluid body if a build would give the same: the file can be read and has the name,
/// source, settings, program, version and solver revision given by `name` and `provenance`. Else
/// none.
std::optional<FluidBody> readIfSame(const std::filesystem::path& file, const std::string& name,
                                    const Provenance& provenance);

/// Name of the .ambient file for a cache: a hash of all that readIfSame() compares.
std::string keptFileName(const std::string& name, const Provenance& provenance);

}  // namespace ambient
