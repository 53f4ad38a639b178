#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "preprocess/builder/parse_exit.h"

namespace ambient {

/// Parses a command line. Returns the program's exit code if it ends with that, as exitAt().
inline std::optional<int> parseOrExit(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return exitAt(app, error);
  }
  return std::nullopt;
}

}  // namespace ambient
