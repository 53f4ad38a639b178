#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/polar/polar.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {
namespace {

/// Options of ambient_preprocess polar; its help says what they mean.
struct PolarArguments {
  std::string file, attack = "-90:90:5", side_slip = "0", forward = "x", up = "z";
  double density = 1, speed = 1, viscosity = 0;  // [kg/m^3], [m/s], [Pa s]
  double separation_angle = kPi / 2;             // [rad]
  double roughness = 0;                          // [m]
  std::string law = "form";
  double reference_area = 0, reference_length = 0;  // [m^2], [m]; 0: those of the body
};

/// Angles [degrees] of one variable.
struct AngleRange {
  double from = 0, to = 0, step = 1;

  int count() const { return 1 + static_cast<int>(std::floor((to - from) / step + 1e-9)); }
  double operator[](int i) const { return from + i * step; }
};

AngleRange parseRange(const std::string& option, const std::string& text) {
  std::istringstream stream(text);
  AngleRange range;
  stream >> range.from;
  range.to = range.from;
  char colon_1 = ':', colon_2 = ':';
  if (!stream.eof() && stream.peek() == ':') stream >> colon_1 >> range.to >> colon_2 >> range.step;
  const bool is_read = !stream.fail() && colon_1 == ':' && colon_2 == ':' &&
                       (stream.eof() || stream.peek() == std::istringstream::traits_type::eof());
  constexpr int kMostAngles = 100000;
  if (!is_read || !std::isfinite(range.from) || !std::isfinite(range.to) || !(range.step > 0) ||
      range.to < range.from || (range.to - range.from) / range.step > kMostAngles) {
    raiseUsageError(option, "\"", text, "\" is neither an angle nor FROM:TO:STEP in degrees, with ",
                    "STEP above 0, TO not below FROM and at most ", kMostAngles, " angles");
  }
  return range;
}

PolarReference referenceOf(const PolarArguments& arguments, const FluidBody& body,
                           const Matrix3& axes) {
  PolarReference reference = usualReference(body, axes);
  if (arguments.reference_area > 0) reference.area = arguments.reference_area;
  if (arguments.reference_length > 0) reference.length = arguments.reference_length;
  if (!(reference.area > 0)) {
    raiseInputError(arguments.file, "has no area seen along --up: give --reference-area");
  }
  if (!(reference.length > 0)) {
    raiseInputError(arguments.file, "has no length along --forward: give --reference-length");
  }
  return reference;
}

void checkNumbers(const PolarArguments& arguments) {
  requirePositive("--density", arguments.density);
  requirePositive("--speed", arguments.speed);
  requireNotNegative("--viscosity", arguments.viscosity);
  requireNotNegative("--reference-area", arguments.reference_area);
  requireNotNegative("--reference-length", arguments.reference_length);
}

void runPolar(const PolarArguments& arguments) {
  const AngleRange attack = parseRange("--attack", arguments.attack);
  const AngleRange side_slip = parseRange("--side-slip", arguments.side_slip);
  constexpr double kMostRows = 1e6;
  if (static_cast<double>(attack.count()) * side_slip.count() > kMostRows) {
    raiseUsageError("--side-slip", attack.count(), " angles of attack times ", side_slip.count(),
                    " of side-slip are more than ", kMostRows);
  }
  const Matrix3 axes = flightAxesOf(arguments.forward, arguments.up);
  checkNumbers(arguments);
  FlowSettings flow;
  flow.separation_angle = separationAngleOf(arguments.separation_angle);
  requireNotNegative("--roughness", arguments.roughness);
  flow.roughness = arguments.roughness;
  flow.law = lawOf(arguments.law);
  const Medium medium{arguments.density, arguments.viscosity, Vector3::Zero(), Vector3::Zero()};
  const FluidBody body = readPrepared(arguments.file);
  const BodyLoads loads(body, medium, flow);
  const PolarFlight flight{axes, arguments.density, arguments.speed,
                           referenceOf(arguments, body, axes),
                           body.added_mass.bottomRightCorner<3, 3>()};
  const double dynamic_pressure = 0.5 * arguments.density * arguments.speed * arguments.speed;
  std::string text = "attack,side_slip,C_L,C_D,C_Y,C_l,C_m,C_n\n";
  for (int j = 0; j < side_slip.count(); ++j) {
    for (int i = 0; i < attack.count(); ++i) {
      const PolarCoefficients coefficients =
          polarCoefficients(loads, flight, attack[i] * kPi / 180, side_slip[j] * kPi / 180);
      for (const double value : coefficients) {
        if (std::isfinite(value) && std::isfinite(dynamic_pressure)) continue;
        raiseInputError(arguments.file, "a coefficient at an angle of attack of ", attack[i],
                        " degrees is not finite: speed or reference is too large or too small");
      }
      char cell[40];
      std::snprintf(cell, sizeof cell, "%.10g,%.10g", attack[i], side_slip[j]);
      text += cell;
      for (const double value : coefficients) {
        std::snprintf(cell, sizeof cell, ",%.9g", value + 0.0);
        text += cell;
      }
      text += "\n";
    }
  }
  std::fprintf(stderr, "reference area %.9g m^2, reference length %.9g m\n", flight.reference.area,
               flight.reference.length);
  std::cout << text;
}

}  // namespace

void addPolar(CLI::App& app) {
  const auto arguments = std::make_shared<PolarArguments>();
  CLI::App& command = *app.add_subcommand(
      "polar", "Coefficients of lift, drag and moment against the angles of the flow, as CSV");
  command.add_option("FILE", arguments->file, "An .ambient file")->required();
  addOption(command, "--attack", arguments->attack, "FROM:TO:STEP",
            "Angle of attack in degrees (default -90:90:5)");
  addOption(command, "--side-slip", arguments->side_slip, "FROM:TO:STEP",
            "Angle of side-slip in degrees (default 0)");
  addOption(command, "--forward", arguments->forward, "AXIS",
            "The body's forward axis (default x)");
  addOption(command, "--up", arguments->up, "AXIS", "The body's upward axis (default z)");
  addOption(command, "--density", arguments->density, "RHO", "Of the fluid [kg/m^3] (default 1)");
  addOption(command, "--speed", arguments->speed, "V",
            "[m/s] (default 1); matters with viscosity only");
  addOption(command, "--viscosity", arguments->viscosity, "MU",
            "Dynamic viscosity [Pa s] (default 0: no friction)");
  addOption(command, "--roughness", arguments->roughness, "K",
            "Height of the roughness of the surface [m] (default 0: smooth)");
  addOption(command, "--separation-angle", arguments->separation_angle, "RAD",
            "From pi/2 (default) to pi, of the published law");
  addLaw(command, arguments->law);
  addOption(command, "--reference-area", arguments->reference_area, "A",
            "[m^2] (default: half the area projected along --up)");
  addOption(command, "--reference-length", arguments->reference_length, "L",
            "[m] (default: extent along --forward)");
  command.callback([arguments] { runPolar(*arguments); });
}

}  // namespace ambient
