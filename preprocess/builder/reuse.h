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

/// Name of the .ambient file in which caches keep it: a hash of all that readIfSame() compares.
std::string keptFileName(const std::string& name, const Provenance& provenance);

}  // namespace ambient
