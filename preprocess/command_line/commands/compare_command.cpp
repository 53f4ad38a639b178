#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/json_numbers.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/polar/body_loads.h"

namespace ambient {
namespace {

/// Options of ambient_preprocess compare; its help says what they mean.
struct CompareArguments {
  std::string first, second;
  double tolerance = 1e-6;
  std::string law = "form";
  bool json = false;
};

/// Name and size of one difference, over what it is a part of [1].
using Difference = std::pair<const char*, double>;

double relativeTo(double scale, double difference) {
  if (difference == 0) return 0;
  return scale > 0 ? difference / scale : HUGE_VAL;
}

double relative(double a, double b) {
  return relativeTo(std::max(std::abs(a), std::abs(b)), std::abs(a - b));
}

/// Largest difference of two blocks of the added mass, over the size that its rows and columns have
/// on the diagonals.
double blockDifference(const Matrix6& a, const Matrix6& b, int row, int column) {
  const auto diagonal = [&](int first) {
    return std::max(a.diagonal().segment<3>(first).maxCoeff(),
                    b.diagonal().segment<3>(first).maxCoeff());
  };
  const double scale = std::sqrt(diagonal(row) * diagonal(column));
  return relativeTo(scale, (a - b).block<3, 3>(row, column).cwiseAbs().maxCoeff());
}

double massDifference(const MassDistribution& a, const MassDistribution& b) {
  const double inertia = std::max(a.inertia.cwiseAbs().maxCoeff(), b.inertia.cwiseAbs().maxCoeff());
  return std::max(relativeTo(std::sqrt(inertia), (a.centre - b.centre).norm()),
                  relativeTo(inertia, (a.inertia - b.inertia).cwiseAbs().maxCoeff()));
}

Twist testTwist(int i, int count, double length) {
  // A spiral over the sphere of directions; every other motion turns too.
  constexpr double kGoldenAngle = 2.39996322972865332;
  const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
  const Vector3 direction(r * portable::cos(kGoldenAngle * i), r * portable::sin(kGoldenAngle * i),
                          z);
  Twist twist{Vector3::Zero(), direction};
  if (i % 2 == 1) twist.angular = Vector3(direction.y(), direction.z(), direction.x()) / length;
  return twist;
}

/// Largest difference of the pressure loads over a spiral of motions, over the dynamic pressure
/// times the area.
double loadDifference(const FluidBody& a, const FluidBody& b, PressureLaw law) {
  constexpr int kMotions = 64;
  const double length = std::sqrt(std::max(a.area, b.area));
  if (!(length > 0)) return 0;
  Medium medium;
  medium.density = 2;  // dynamic pressure 1 at speed 1
  FlowSettings flow;
  flow.law = law;
  const BodyLoads loads_on_a(a, medium, flow), loads_on_b(b, medium, flow);
  double largest = 0;
  for (int i = 0; i < kMotions; ++i) {
    const Twist twist = testTwist(i, kMotions, length);
    const Wrench of_a = loads_on_a.at(twist).pressure;
    const Wrench of_b = loads_on_b.at(twist).pressure;
    largest = std::max({largest, (of_a.force - of_b.force).norm() / (length * length),
                        (of_a.torque - of_b.torque).norm() / (length * length * length)});
  }
  return largest;
}

std::vector<Difference> differencesOf(const FluidBody& a, const FluidBody& b, PressureLaw law) {
  const double length = std::sqrt(std::max(a.area, b.area));
  return {
      {"added_mass_rotation", blockDifference(a.added_mass, b.added_mass, 0, 0)},
      {"added_mass_coupling", blockDifference(a.added_mass, b.added_mass, 0, 3)},
      {"added_mass_translation", blockDifference(a.added_mass, b.added_mass, 3, 3)},
      {"volume", relative(a.volume, b.volume)},
      {"area", relative(a.area, b.area)},
      {"centre_of_volume", relativeTo(length, (a.centre_of_volume - b.centre_of_volume).norm())},
      {"uniform_mass", massDifference(a.uniform_mass, b.uniform_mass)},
      {"surface_mass", massDifference(a.surface_mass, b.surface_mass)},
      {"pressure", loadDifference(a, b, law)}};
}

std::string comparisonJson(const std::vector<Difference>& differences, double tolerance,
                           bool is_same) {
  nlohmann::ordered_json report;
  for (const Difference& d : differences) report[d.first] = d.second;
  report["tolerance"] = tolerance;
  report["same"] = is_same;
  return jsonText(report);
}

std::string comparisonTable(const std::vector<Difference>& differences, double tolerance) {
  std::string text;
  for (const Difference& d : differences) {
    char row[80];
    std::snprintf(row, sizeof row, "%-24s %12.4e%s\n", d.first, d.second,
                  d.second <= tolerance ? "" : "  beyond the tolerance");
    text += row;
  }
  return text;
}

int runCompare(const CompareArguments& arguments) {
  requireNotNegative("--tolerance", arguments.tolerance);
  const PressureLaw law = lawOf(arguments.law);
  const FluidBody a = readFluidBody(arguments.first), b = readFluidBody(arguments.second);
  const std::vector<Difference> differences = differencesOf(a, b, law);
  const bool is_same =
      std::all_of(differences.begin(), differences.end(),
                  [&](const Difference& d) { return d.second <= arguments.tolerance; });
  std::cout << (arguments.json ? comparisonJson(differences, arguments.tolerance, is_same)
                               : comparisonTable(differences, arguments.tolerance));
  return is_same ? 0 : 1;
}

}  // namespace

void addCompare(CLI::App& app) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App& command =
      *app.add_subcommand("compare", "Relative differences of two .ambient files; status 1 if any");
  command.add_option("A", arguments->first, "An .ambient file")->required();
  command.add_option("B", arguments->second, "Another one")->required();
  addOption(command, "--tolerance", arguments->tolerance, "T", "Relative (default 1e-6)");
  addLaw(command, arguments->law);
  addJson(command, arguments->json);
  command.callback([arguments] {
    if (const int status = runCompare(*arguments); status != 0) throw CLI::RuntimeError(status);
  });
}

}  // namespace ambient
