#pragma once

#include <memory>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/hand_over/handed_body.h"

namespace ambient {

/// Returns the format with a name. @throws std::invalid_argument in one line, if there is none.
ExportFormat exportFormatOf(const std::string& name);

/// Converts a fluid body to the format of another program; docs/file_format.md has frames, units
/// and what each format loses. The same body and settings give the same bytes.
/// @throws std::invalid_argument in one line that names the fluid body, the value and the limit, if
/// a number is not physical, or a draught is asked for of a body without parts of its added mass.
ExportedBody exportFluidBody(const std::shared_ptr<const FluidBody>& body, ExportFormat format,
                             const ExportSettings& settings);

}  // namespace ambient
