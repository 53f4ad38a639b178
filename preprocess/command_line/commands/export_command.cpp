#include <iostream>
#include <memory>

#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/hand_over/handed_body.h"
#include "preprocess/polar/polar.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {
namespace {

/// Options of ambient_preprocess export; its help says what they mean.
struct ExportArguments {
  std::string file, format, output, forward = "x", up = "z";
  std::vector<double> centre_of_mass;  // in F [m]; empty: default
  ExportSettings settings;
};

ExportFormat formatOf(const ExportArguments& arguments) {
  try {
    return exportFormatOf(arguments.format);
  } catch (const std::invalid_argument& error) {
    raiseUsageError("--format", error.what());
  }
}

ExportSettings settingsOf(const ExportArguments& arguments, ExportFormat format) {
  ExportSettings settings = arguments.settings;
  requirePositive("--density", settings.medium.density, " kg/m^3");
  requireMedium(settings.medium);
  requirePositive("--gravity", settings.gravity, " m/s^2");
  if (settings.mass) requirePositive("--mass", *settings.mass, " kg");
  if (settings.draught) requirePositive("--draught", *settings.draught, " m");
  if (settings.speed) requirePositive("--speed", *settings.speed, " m/s");
  if (settings.speed && format != ExportFormat::kFossen)
    raiseUsageError("--speed", *settings.speed, " m/s is for fossen only");
  if (!arguments.centre_of_mass.empty())
    settings.centre_of_mass =
        Vector3(Eigen::Map<const Eigen::Vector3d>(arguments.centre_of_mass.data()));
  const Matrix3 axes = flightAxesOf(arguments.forward, arguments.up);
  settings.forward = axes.col(0);
  settings.up = axes.col(2);
  return settings;
}

ExportedBody exported(const ExportArguments& arguments, ExportFormat format,
                      const ExportSettings& settings) {
  const auto body = std::make_shared<const FluidBody>(readPrepared(arguments.file));
  try {
    return exportFluidBody(body, format, settings);
  } catch (const std::invalid_argument& error) {
    raiseInputError(arguments.file, error.what());
  }
}

void runExport(const ExportArguments& arguments) {
  const ExportFormat format = formatOf(arguments);
  const ExportSettings settings = settingsOf(arguments, format);
  if (!arguments.output.empty()) requireWritablePlace(arguments.output, arguments.file);
  const ExportedBody made = exported(arguments, format, settings);
  if (arguments.output.empty()) {
    std::cout << made.bytes;
    return;
  }
  made.write(arguments.output);
  std::cout << made.report;
}

}  // namespace

void addExport(CLI::App& app) {
  const auto arguments = std::make_shared<ExportArguments>();
  ExportSettings& settings = arguments->settings;
  CLI::App& command = *app.add_subcommand("export", "Hands a fluid body over to other programs");
  command.add_option("FILE", arguments->file, "An .ambient file")->required();
  addOption(command, "--format", arguments->format, "FORMAT",
            "sdf (SDFormat, Gazebo), mjcf (MuJoCo) or fossen (JSON)")
      ->required();
  addOption(command, "-o,--output", arguments->output, "FILE",
            "Where it goes; default: standard output");
  addOption(command, "--density", settings.medium.density, "RHO",
            "Of the fluid [kg/m^3] (default 998)");
  addOption(command, "--viscosity", settings.medium.viscosity, "MU",
            "Dynamic viscosity [Pa s] (default 0.001002)");
  addOption(command, "--gravity", settings.gravity, "G", "[m/s^2] (default 9.81)");
  addOption(command, "--mass", settings.mass, "KG",
            "Of the body (default: that of the fluid which it displaces)");
  addOption(command, "--centre-of-mass", arguments->centre_of_mass, "X Y Z",
            "In the body's frame [m]; default: that of a mass spread evenly")
      ->expected(3);
  addOption(command, "--forward", arguments->forward, "AXIS",
            "The body's forward axis (default x)");
  addOption(command, "--up", arguments->up, "AXIS", "The body's upward axis (default z)");
  addOption(command, "--draught", settings.draught, "D",
            "Depth of the lowest point below the surface [m]; default: no surface is near");
  addOption(command, "--speed", settings.speed, "V",
            "Along --forward, for the linearised drag of fossen [m/s]");
  command.callback([arguments] { runExport(*arguments); });
}

}  // namespace ambient
