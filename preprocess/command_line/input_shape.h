#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "preprocess/shape/shapes.h"

namespace ambient {

/// Whether a file name ends with an extension, ".json", in letters of either case.
bool hasExtension(const std::filesystem::path& file, const std::string& extension);

/// Options that say how an INPUT is used.
struct InputOptions {
  bool sheet = false;               ///< an open surface of zero thickness
  bool hull = false;                ///< the convex hull stands for it
  std::optional<std::string> wrap;  ///< a closed surface around it does, of that size [m]
  double scale = 1;                 ///< that multiplies all lengths of the result
};

/// Adds --scale, --sheet, --hull and --wrap [SIZE].
void addInputOptions(CLI::App& command, InputOptions& options);

/// The shape that an INPUT of the command line stands for: a mesh file, or a JSON file with a
/// shape.
/// @throws UsageError for options that exclude each other.
/// @throws std::runtime_error in one line that names the file.
ShapeDescription describeInput(const std::filesystem::path& input, const InputOptions& options);

}  // namespace ambient
