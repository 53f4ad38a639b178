#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "bullet_ambient/spatial/pi.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/polar/polar.h"

namespace ambient {
namespace {

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

Vector3 parseAxis(const char* option, const std::string& text) {
  try {
    return axisNamed(text);
  } catch (const std::invalid_argument& error) {
    raiseUsageError(option, error.what());
  }
}

Matrix3 parseAxes(const std::string& forward, const std::string& up) {
  const Vector3 ahead = parseAxis("--forward", forward), above = parseAxis("--up", up);
  if (ahead.dot(above) != 0) raiseUsageError("--up", up, " is along --forward ", forward);
  return flightAxes(ahead, above);
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

}  // namespace

void runPolar(const PolarArguments& arguments) {
  const AngleRange attack = parseRange("--attack", arguments.attack);
  const AngleRange side_slip = parseRange("--side-slip", arguments.side_slip);
  constexpr double kMostRows = 1e6;
  if (static_cast<double>(attack.count()) * side_slip.count() > kMostRows) {
    raiseUsageError("--side-slip", attack.count(), " angles of attack times ", side_slip.count(),
                    " of side-slip are more than ", kMostRows);
  }
  const Matrix3 axes = parseAxes(arguments.forward, arguments.up);
  checkNumbers(arguments);
  FlowSettings flow;
  flow.separation_angle = separationAngleOf(arguments.separation_angle);
  flow.law = lawOf(arguments.law);
  const Medium medium{arguments.density, arguments.viscosity, Vector3::Zero(), Vector3::Zero()};
  const FluidBody body = readFluidBody(arguments.file);
  const BodyLoads loads(body, medium, flow);
  const PolarFlight flight{axes, arguments.density, arguments.speed,
                           referenceOf(arguments, body, axes)};
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

}  // namespace ambient
