#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "bullet_ambient/spatial/pi.h"
#include "preprocess/command_line/body_loads.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/option_values.h"

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

/// Forward, left and up, right-handed, as columns in F.
Matrix3 parseAxes(const std::string& forward, const std::string& up) {
  const auto axisOf = [](const char* option, const std::string& text) {
    const bool has_sign = text.size() == 2 && (text[0] == '-' || text[0] == '+');
    const char letter = text.empty() ? ' ' : text.back();
    if ((text.size() != 1 && !has_sign) || letter < 'x' || letter > 'z') {
      raiseUsageError(option, "\"", text, "\" is none of x, y, z, -x, -y, -z");
    }
    Vector3 axis = Vector3::Zero();
    axis[letter - 'x'] = text[0] == '-' ? -1 : 1;
    return axis;
  };
  Matrix3 axes;
  axes.col(0) = axisOf("--forward", forward);
  axes.col(2) = axisOf("--up", up);
  if (axes.col(0).dot(axes.col(2)) != 0) {
    raiseUsageError("--up", up, " is along --forward ", forward);
  }
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

struct Reference {
  double area = 0;
  double length = 0;
};

/// Half the area projected along an axis, both sides counted: the silhouette of a convex body or of
/// a flat sheet.
double silhouetteAlong(const Vector3& axis, const FluidBody& body) {
  if (body.sphere_radius > 0) return kPi * body.sphere_radius * body.sphere_radius;
  const FaceTable& faces = body.faces;
  double sum = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    sum += faces.area[i] * std::abs(faces.normal(i).dot(axis));
  }
  return sum / 2;
}

double extentAlong(const Vector3& axis, const FluidBody& body) {
  if (body.sphere_radius > 0) return 2 * body.sphere_radius;
  return axis.cwiseAbs().dot(extentsOf(body));
}

Reference referenceOf(const PolarArguments& arguments, const FluidBody& body, const Matrix3& axes) {
  Reference reference;
  reference.area =
      arguments.reference_area > 0 ? arguments.reference_area : silhouetteAlong(axes.col(2), body);
  reference.length =
      arguments.reference_length > 0 ? arguments.reference_length : extentAlong(axes.col(0), body);
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

/// C_L, C_D, C_Y, C_l, C_m, C_n at one attitude; forward, left and up axes.
std::array<double, 6> coefficientsAt(double attack, double side_slip, const BodyLoads& loads,
                                     const Matrix3& axes, const PolarArguments& arguments,
                                     const Reference& reference) {
  const double ca = std::cos(attack), sa = std::sin(attack);
  const double cb = std::cos(side_slip), sb = std::sin(side_slip);
  const Vector3 motion(ca * cb, -sb, -sa * cb), lift(sa, 0, ca);
  const Vector3 side = motion.cross(lift);  // to the right
  const Twist twist{Vector3::Zero(), axes * motion * arguments.speed};
  const Wrench load = loads.at(twist).total();
  const double scale = 0.5 * arguments.density * arguments.speed * arguments.speed * reference.area;
  const Vector3 force = axes.transpose() * load.force / scale;
  const Vector3 moment = axes.transpose() * load.torque / (scale * reference.length);
  return {force.dot(lift), -force.dot(motion), force.dot(side),
          moment.x(),      -moment.y(),        -moment.z()};
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
  const Reference reference = referenceOf(arguments, body, axes);
  const double dynamic_pressure = 0.5 * arguments.density * arguments.speed * arguments.speed;
  std::string text = "attack,side_slip,C_L,C_D,C_Y,C_l,C_m,C_n\n";
  for (int j = 0; j < side_slip.count(); ++j) {
    for (int i = 0; i < attack.count(); ++i) {
      const auto coefficients = coefficientsAt(attack[i] * kPi / 180, side_slip[j] * kPi / 180,
                                               loads, axes, arguments, reference);
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
  std::fprintf(stderr, "reference area %.9g m^2, reference length %.9g m\n", reference.area,
               reference.length);
  std::cout << text;
}

}  // namespace ambient
