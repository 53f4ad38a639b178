#include <cmath>
#include <iostream>
#include <limits>
#include <memory>

#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/polar/polar.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {
namespace {

/// Options of ambient_preprocess loads; its help says what they mean.
struct LoadsArguments {
  std::string file;
  std::array<double, 6> twist{};      // relative to the fluid, angular velocity first
  double density = 0, viscosity = 0;  // [kg/m^3], [Pa s]
  FlowOptions flow;
  bool no_friction = false, json = false;
};

Medium mediumOf(const LoadsArguments& arguments) {
  requireNotNegative("--density", arguments.density, " kg/m^3");
  requireNotNegative("--viscosity", arguments.viscosity, " Pa s");
  return {arguments.density, arguments.viscosity, Vector3::Zero(), Vector3::Zero()};
}

Twist twistOf(const LoadsArguments& arguments) {
  Vector6 twist;
  for (int i = 0; i < 6; ++i) {
    twist[i] = arguments.twist[i];
    if (!std::isfinite(twist[i])) {
      raiseUsageError("--twist", "number ", i + 1, " is ", twist[i], ", must be finite");
    }
  }
  return Twist::fromVector(twist);
}

void runLoads(const LoadsArguments& arguments) {
  const Medium medium = mediumOf(arguments);
  FlowSettings flow = flowOf(arguments.flow);
  flow.skin_friction = !arguments.no_friction;
  const Twist twist = twistOf(arguments);
  const FaceLoads loads = BodyLoads(readPrepared(arguments.file), medium, flow).at(twist);
  const double dynamic_pressure = medium.density * twist.vector().squaredNorm();
  if (!std::isfinite(dynamic_pressure) || !loads.total().vector().allFinite()) {
    raiseInputError(arguments.file, "the loads of this motion are beyond the largest number, ",
                    std::numeric_limits<double>::max());
  }
  std::cout << factsText({{"pressure", vectorJson(loads.pressure.vector())},
                          {"friction", vectorJson(loads.friction.vector())},
                          {"total", vectorJson(loads.total().vector())}},
                         arguments.json);
}

}  // namespace

void addLoads(CLI::App& app) {
  const auto arguments = std::make_shared<LoadsArguments>();
  CLI::App& command = *app.add_subcommand(
      "loads", "Evaluates pressure and friction for one motion relative to the fluid");
  command.add_option("FILE", arguments->file, "An .ambient file")->required();
  addOption(command, "--twist", arguments->twist, "WX WY WZ VX VY VZ",
            "Angular and linear velocity of the body frame's origin, body axes [rad/s, m/s]")
      ->required();
  addOption(command, "--density", arguments->density, "RHO", "Of the fluid [kg/m^3]")->required();
  addOption(command, "--viscosity", arguments->viscosity, "MU",
            "Dynamic viscosity [Pa s] (default 0: no friction)");
  addFlowOptions(command, arguments->flow);
  command.add_flag("--no-friction", arguments->no_friction, "Leave skin friction out");
  addJson(command, arguments->json);
  command.callback([arguments] { runLoads(*arguments); });
}

}  // namespace ambient
