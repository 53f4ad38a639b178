#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "preprocess/shape/shapes.h"

namespace ambient {

/// True if a file name ends with an extension, such as ".json", in upper or lower case.
bool hasExtension(const std::filesystem::path& file, const std::string& extension);

/// Options that say how an INPUT is used.
struct InputOptions {
  bool sheet = false;  ///< an open surface of zero thickness
  bool hull = false;   ///< true: use the convex hull
  std::optional<std::string>
      wrap;             ///< use a closed surface around the mesh; value: its size [m] as text
  double scale = 1;     ///< factor on all lengths of the result
  bool strict = false;  ///< refuse what is not a closed body after mending, in place of wrapping it
};

/// Adds --scale, --sheet, --hull, --wrap [SIZE] and --strict.
void addInputOptions(CLI::App& command, InputOptions& options);

/// Reads the shape of an INPUT of the command line: a mesh file, or a JSON file with a shape.
/// @throws UsageError for options that exclude each other.
/// @throws std::runtime_error in one line that names the file.
ShapeDescription describeInput(const std::filesystem::path& input, const InputOptions& options);

}  // namespace ambient
