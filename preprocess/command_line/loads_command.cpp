#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/json_numbers.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/polar/body_loads.h"

namespace ambient {
namespace {

Medium mediumOf(const LoadsArguments& arguments) {
  requireNotNegative("--density", arguments.density, " kg/m^3");
  requireNotNegative("--viscosity", arguments.viscosity, " Pa s");
  return {arguments.density, arguments.viscosity, Vector3::Zero(), Vector3::Zero()};
}

FlowSettings flowOf(const LoadsArguments& arguments) {
  FlowSettings flow;
  flow.separation_angle = separationAngleOf(arguments.separation_angle);
  flow.law = lawOf(arguments.law);
  flow.skin_friction = !arguments.no_friction;
  return flow;
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

std::string loadsJson(const FaceLoads& loads) {
  const nlohmann::ordered_json report{{"pressure", vectorJson(loads.pressure.vector())},
                                      {"friction", vectorJson(loads.friction.vector())},
                                      {"total", vectorJson(loads.total().vector())}};
  return jsonText(report);
}

std::string loadsTable(const FaceLoads& loads) {
  std::string text =
      "               torque about the origin of F [N m]            force [N]\n"
      "                      x            y            z            x            y            z\n";
  const auto append = [&text](const char* label, const Wrench& wrench) {
    char cell[32];
    std::snprintf(cell, sizeof cell, "%-10s", label);
    text += cell;
    const Vector6 numbers = wrench.vector();
    for (int i = 0; i < 6; ++i) {
      std::snprintf(cell, sizeof cell, "%13.5e", numbers[i]);
      text += cell;
    }
    text += "\n";
  };
  append("pressure", loads.pressure);
  append("friction", loads.friction);
  append("total", loads.total());
  return text;
}

}  // namespace

void runLoads(const LoadsArguments& arguments) {
  const Medium medium = mediumOf(arguments);
  const FlowSettings flow = flowOf(arguments);
  const Twist twist = twistOf(arguments);
  const FaceLoads loads = BodyLoads(readFluidBody(arguments.file), medium, flow).at(twist);
  const double dynamic_pressure = medium.density * twist.vector().squaredNorm();
  if (!std::isfinite(dynamic_pressure) || !loads.total().vector().allFinite()) {
    raiseInputError(arguments.file, "the loads of this motion are beyond the largest number, ",
                    std::numeric_limits<double>::max());
  }
  std::cout << (arguments.json ? loadsJson(loads) : loadsTable(loads));
}

}  // namespace ambient
