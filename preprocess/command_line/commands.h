#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/command_line/option_values.h"

namespace ambient {

// Each of these adds one command to ambient_preprocess. Parsing a command line with it runs it: its
// result goes to standard output, messages and progress go to standard error. Parsing then throws
// - CLI::RuntimeError with exit status 1 if the command has told about bad input and gone on;
// - UsageError in one line that names the option, the value and the limit;
// - std::runtime_error in one line that names the file, the entity and the limit.
void addBuild(CLI::App& app);
void addCheck(CLI::App& app);
void addExport(CLI::App& app);
void addUpgrade(CLI::App& app);
void addInspect(CLI::App& app);
void addLoads(CLI::App& app);
void addPolar(CLI::App& app);

/// Options of ambient_preprocess build; its help says what they mean.
struct BuildArguments {
  std::string input, output;
  InputOptions options;
  std::string origin = "centre-of-volume";
  int least_faces = 0, panels = kDefaultPanels, threads = 0;
  std::vector<int> levels;
  std::vector<double> drag;
  std::string wings = "none";
  std::vector<std::string> tanks;
  std::vector<double> openings;  // seven numbers of each
  int waterline = 0;             // subdivisions
  bool no_tables = false, rebuild = false, json = false;
};

/// Builds the fluid bodies of a .bullet file into a folder; returns the exit status, 1 if a shape
/// failed or a body was left out.
int buildWorldFile(const BuildArguments& arguments);

}  // namespace ambient
