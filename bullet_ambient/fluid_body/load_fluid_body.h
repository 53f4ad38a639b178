#pragma once

#include <memory>
#include <string>

namespace ambient {

struct FluidBody;

/// readFluidBody() of fluid_body_file.h, to be shared by all bodies of the shape.
/// @throws std::runtime_error as readFluidBody().
std::shared_ptr<const FluidBody> loadFluidBody(const std::string& file);

}  // namespace ambient
