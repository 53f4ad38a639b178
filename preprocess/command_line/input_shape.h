#pragma once

#include <filesystem>
#include <string>

#include "preprocess/shape/shape_description.h"

namespace ambient {

/// Whether a file name ends with an extension, ".json", in letters of either case.
bool hasExtension(const std::filesystem::path& file, const std::string& extension);

/// The shape that an INPUT of the command line stands for: a mesh file, or a JSON file with a
/// shape.
/// @throws std::runtime_error in one line that names the file.
ShapeDescription describeInput(const std::filesystem::path& input, bool sheet);

}  // namespace ambient
