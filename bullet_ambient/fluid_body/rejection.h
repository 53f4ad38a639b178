#pragma once

#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// @throws std::invalid_argument: one line that names the fluid body, the value and the limit.
[[noreturn]] void reject(const FluidBody& body, const std::string& what, double value,
                         const char* limit);

}  // namespace ambient
