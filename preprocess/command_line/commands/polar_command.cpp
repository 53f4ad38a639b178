#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/viscous_law.h"
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
  const Medium medium{arguments.density, arguments.viscosity, Vector3::Zero(), Vector3::Zero()};
  requireMedium(medium);
  return medium;
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
  if (!loads.total().vector().allFinite())
    raiseInputError(arguments.file, "the loads of this motion are beyond the largest number, ",
                    std::numeric_limits<double>::max(), ", or its Reynolds number beyond ",
                    kMostReynolds);
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

namespace {

/// Options of ambient_preprocess polar; its help says what they mean.
struct PolarArguments {
  std::string file, attack = "-90:90:5", side_slip = "0", reynolds, forward = "x", up = "z";
  double density = 1, speed = 1, viscosity = 0;  // [kg/m^3], [m/s], [Pa s]
  FlowOptions flow;
  double reference_area = 0, reference_length = 0;  // [m^2], [m]; 0: those of the body
};

/// Angles [degrees] of one variable.
struct AngleRange {
  double from = 0, to = 0, step = 1;

  int count() const { return 1 + static_cast<int>(std::floor((to - from) / step + 1e-9)); }
  double operator[](int i) const { return from + i * step; }
};

/// Reads numbers with colons between them; none: the text is something else.
std::vector<double> numbersIn(const std::string& text) {
  std::istringstream stream(text);
  std::vector<double> numbers;
  char colon = ':';
  for (double number = 0; colon == ':' && stream >> number;) {
    numbers.push_back(number);
    if (!(stream >> colon)) return numbers;
  }
  return {};
}

AngleRange parseRange(const std::string& option, const std::string& text) {
  std::vector<double> numbers = numbersIn(text);
  if (numbers.size() == 1) numbers.insert(numbers.end(), {numbers[0], 1});
  constexpr int kMostAngles = 100000;
  if (numbers.size() != 3 || !(numbers[2] > 0) || numbers[1] < numbers[0] ||
      (numbers[1] - numbers[0]) / numbers[2] > kMostAngles) {
    raiseUsageError(option, "\"", text, "\" is neither an angle nor FROM:TO:STEP in degrees, with ",
                    "STEP above 0, TO not below FROM and at most ", kMostAngles, " angles");
  }
  return {numbers[0], numbers[1], numbers[2]};
}

/// Reads Reynolds numbers, evenly spaced in their logarithm.
std::vector<double> parseReynolds(const std::string& text) {
  std::vector<double> range = numbersIn(text);
  if (range.size() == 2) range.push_back(10);
  constexpr double kLeast = 1e-6, kLargest = 1e12, kMostPerDecade = 1000;
  if (range.size() != 3 || range[0] < kLeast || range[1] < range[0] || range[1] > kLargest ||
      range[2] < 1 || range[2] > kMostPerDecade) {
    raiseUsageError("--reynolds", "\"", text, "\" is not FROM:TO[:PER_DECADE] with FROM from ",
                    kLeast, " on, TO up to ", kLargest, " and not below FROM, PER_DECADE 1 to ",
                    kMostPerDecade);
  }
  const double step = portable::log(10) / range[2], rounding = 1e-9;
  const double steps = portable::log(range[1] / range[0]) / step + rounding;
  std::vector<double> numbers;
  for (int i = 0; i <= steps; ++i) numbers.push_back(range[0] * portable::exp(i * step));
  return numbers;
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

/// Computes C_D along forward at a Reynolds number on D_A.
double dragAt(double reynolds, const std::shared_ptr<const FluidBody>& body,
              const FlowSettings& flow, const PolarFlight& flight) {
  const double diameter = std::sqrt(body->area / kPi);
  const double viscosity = flight.density * flight.speed * diameter / reynolds;
  const Medium medium{flight.density, viscosity, Vector3::Zero(), Vector3::Zero()};
  return polarCoefficients(BodyLoads(body, medium, flow), flight, 0, 0)[1];
}

/// Prints C_D along --forward over the Reynolds number, beside that of the smooth ball with the
/// body's area.
void printDrag(const PolarArguments& arguments, const Matrix3& axes, const FlowSettings& flow) {
  const std::vector<double> numbers = parseReynolds(arguments.reynolds);
  const auto body = std::make_shared<const FluidBody>(readPrepared(arguments.file));
  const auto ball = std::make_shared<FluidBody>();
  ball->area = body->area;
  ball->sphere_radius = std::sqrt(body->area / kPi) / 2;
  PolarFlight flight, ball_flight;
  flight.axes = axes;
  ball_flight.reference = {body->area / 4, 1};
  flight.reference = {arguments.reference_area, 1};
  if (arguments.reference_area == 0) flight.reference.area = frontalArea(*body, axes.col(0));
  if (!(flight.reference.area > 0))
    raiseInputError(arguments.file, "has no area seen along --forward: give --reference-area");
  std::string text = "Re,C_D,C_D_of_ball\n";
  for (const double reynolds : numbers) {
    char row[80];
    std::snprintf(row, sizeof row, "%.9g,%.9g,%.9g\n", reynolds,
                  dragAt(reynolds, body, flow, flight), dragAt(reynolds, ball, {}, ball_flight));
    text += row;
  }
  std::fprintf(stderr, "Reynolds number on D_A = sqrt(area/pi) = %.9g m, C_D on %.9g m^2\n",
               2 * ball->sphere_radius, flight.reference.area);
  std::cout << text;
}

void checkNumbers(const PolarArguments& arguments) {
  requirePositive("--density", arguments.density);
  requirePositive("--speed", arguments.speed);
  requireMedium({arguments.density, arguments.viscosity, Vector3::Zero(), Vector3::Zero()});
  requireNotNegative("--reference-area", arguments.reference_area);
  requireNotNegative("--reference-length", arguments.reference_length);
}

/// Sets what rounding has left of coefficients beside the largest to 0.
PolarCoefficients withoutRounding(PolarCoefficients coefficients) {
  constexpr double kRounding = 1e-12;
  double largest = 0;
  for (const double value : coefficients) largest = std::max(largest, std::abs(value));
  for (double& value : coefficients)
    if (std::abs(value) < kRounding * largest) value = 0;
  return coefficients;
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
  const FlowSettings flow = flowOf(arguments.flow);
  if (!arguments.reynolds.empty()) return printDrag(arguments, axes, flow);
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
      for (const double value : withoutRounding(coefficients)) {
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
  addFlowOptions(command, arguments->flow);
  addOption(command, "--reference-area", arguments->reference_area, "A",
            "[m^2] (default: that of the silhouette along --up)");
  addOption(command, "--reference-length", arguments->reference_length, "L",
            "[m] (default: extent along --forward)");
  addOption(command, "--reynolds", arguments->reynolds, "FROM:TO[:PER_DECADE]",
            "C_D along --forward over these Reynolds numbers, 10 a decade, and a smooth ball's");
  command.callback([arguments, &command] {
    for (const char* other :
         {"--attack", "--side-slip", "--density", "--speed", "--viscosity", "--reference-length"})
      if (command.count("--reynolds") > 0 && command.count(other) > 0)
        raiseUsageError("--reynolds", "excludes ", other);
    runPolar(*arguments);
  });
}

}  // namespace ambient
