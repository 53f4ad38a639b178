#pragma once

#include <string>
#include <vector>

#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/command_line/option_values.h"

namespace ambient {

/// Options of ambient_preprocess build; its help says what they mean.
struct BuildArguments {
  std::string input, output;
  InputOptions options;
  std::string origin = "centre-of-volume";
  int least_faces = 0, panels = kDefaultPanels, threads = 0;
  std::vector<int> levels;
  std::vector<double> drag;
  int waterline = 0;  // subdivisions
  bool no_tables = false, rebuild = false, json = false;
};

/// Builds the fluid bodies of a .bullet file into a folder; returns the exit status, 1 if a shape
/// failed or a body was left out.
int buildWorldFile(const BuildArguments& arguments);

}  // namespace ambient
