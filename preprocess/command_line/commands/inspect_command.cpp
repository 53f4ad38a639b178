#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/floating_report.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/json_numbers.h"

namespace ambient {
namespace {

/// Options of ambient_preprocess inspect; its help says what they mean.
struct InspectArguments {
  std::string file;
  std::optional<double> mass;          // [kg]
  std::vector<double> centre_of_mass;  // in F [m]; empty: spread evenly over the volume
  std::vector<double> inertia;         // xx yy zz xy xz yz [kg m^2]; empty: likewise
  double density = 998;                // [kg/m^3]
  double gravity = 9.81;               // [m/s^2]
  bool json = false;
};

/// Returns the body with mass and water of the arguments. Inertia that is not given is that of a
/// mass spread evenly over the volume, even if its centre is given.
FloatingBody onWater(const FluidBody& body, const InspectArguments& arguments) {
  FloatingBody floating;
  floating.shape = std::make_shared<FluidBody>(body);
  floating.mass = *arguments.mass;
  floating.centre_of_mass = body.uniform_mass.centre;
  if (!arguments.centre_of_mass.empty())
    floating.centre_of_mass = Eigen::Map<const Eigen::Vector3d>(arguments.centre_of_mass.data());
  floating.inertia = floating.mass * body.uniform_mass.inertia;
  if (const std::vector<double>& v = arguments.inertia; !v.empty())
    floating.inertia << v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2];
  floating.density = arguments.density;
  floating.gravity = arguments.gravity;
  return floating;
}

std::string inspectionJson(const FluidBody& body, const InspectArguments& arguments) {
  std::string text = reportJson(body, std::nullopt);
  if (!arguments.mass) return text;
  auto report = nlohmann::ordered_json::parse(text);
  report["floating"] = floatingJson(onWater(body, arguments));
  return jsonText(report);
}

void runInspect(const InspectArguments& arguments) {
  const FluidBody body = readFluidBody(arguments.file);
  if (arguments.json) {
    std::cout << inspectionJson(body, arguments);
    return;
  }
  std::string table = reportTable(body, arguments.file);
  if (arguments.mass) table += floatingTable(onWater(body, arguments));
  std::cout << table;
}

}  // namespace

void addInspect(CLI::App& app) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App& command = *app.add_subcommand("inspect", "Shows what an .ambient file holds");
  command.add_option("FILE", arguments->file, "An .ambient file")->required();
  command.add_option("--mass", arguments->mass, "Shows how a body of this mass floats [kg]");
  addOption(command, "--centre-of-mass", arguments->centre_of_mass, "X Y Z",
            "With --mass: in the body's frame [m]; default: that of a mass spread evenly")
      ->expected(3);
  addOption(command, "--inertia", arguments->inertia, "XX YY ZZ XY XZ YZ",
            "With --mass: about the centre of mass, in the body's axes [kg m^2]; default: likewise")
      ->expected(6);
  command.add_option("--density", arguments->density, "With --mass: of the water [kg/m^3]")
      ->capture_default_str();
  command.add_option("--gravity", arguments->gravity, "With --mass: [m/s^2]")
      ->capture_default_str();
  addJson(command, arguments->json);
  command.callback([arguments] { runInspect(*arguments); });
}

}  // namespace ambient
