#pragma once

#include <memory>
#include <string>

namespace ambient {

struct FluidBody;

/// Reads a .ambient file like readFluidBody(); the result is shared by all bodies of the shape.
/// @throws std::runtime_error as readFluidBody().
std::shared_ptr<const FluidBody> loadFluidBody(const std::string& file);

}  // namespace ambient
