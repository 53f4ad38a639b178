#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/floating_report.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/json_numbers.h"

namespace ambient {
namespace {

// Its inertia is that of a mass spread evenly, wherever its centre is.
FloatingBody onWater(const FluidBody& body, const InspectArguments& arguments) {
  FloatingBody floating;
  floating.shape = std::make_shared<FluidBody>(body);
  floating.mass = *arguments.mass;
  floating.centre_of_mass = body.uniform_mass.centre;
  if (!arguments.centre_of_mass.empty())
    floating.centre_of_mass = Eigen::Map<const Eigen::Vector3d>(arguments.centre_of_mass.data());
  floating.inertia = floating.mass * body.uniform_mass.inertia;
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

}  // namespace

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

}  // namespace ambient
