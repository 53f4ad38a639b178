#include <algorithm>
#include <filesystem>
#include <iostream>

#include "bullet_ambient/base/plain_text.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/bullet_world/world_builder.h"
#include "preprocess/command_line/commands/build_arguments.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Status = WorldShapeResult::Status;

void requireWorldOptions(const BuildArguments& arguments) {
  const auto refuse = [](const char* option) {
    raiseUsageError(option, "has no meaning for a world: its shapes keep frame and size");
  };
  const auto refuseForMany = [](const char* option) {
    raiseUsageError(option, "is for one mesh, not for a world");
  };
  if (arguments.options.scale != 1) refuse("--scale");
  if (arguments.origin != "centre-of-volume") refuse("--origin");
  if (arguments.options.sheet) refuse("--sheet");
  if (arguments.options.hull) refuseForMany("--hull");
  if (arguments.options.wrap) refuseForMany("--wrap");
  if (!arguments.options.up.empty()) refuseForMany("--up");
  if (arguments.least_faces != 0) refuse("--least-faces");
  if (!arguments.levels.empty()) refuseForMany("--levels");
  if (arguments.waterline != 0) refuseForMany("--waterline-table");
}

void requireFolder(const fs::path& output) {
  std::error_code error;
  if (fs::exists(output, error) && !fs::is_directory(output, error)) {
    raiseInputError(output.string(), "is a file; the output of a world is a folder");
  }
}

const char* wordFor(Status status) {
  if (status == Status::kFailed) return "failed";
  return status == Status::kKept ? "kept" : "built";
}

ordered_json shapeJson(const WorldShapeResult& shape) {
  ordered_json report{{"name", shape.name},
                      {"file", shape.file.string()},
                      {"status", wordFor(shape.status)},
                      {"bodies", shape.bodies},
                      {"seconds", shape.seconds}};
  if (shape.status == Status::kFailed) {
    report["message"] = shape.message;
  } else {
    report["faces"] = shape.faces;
    report["size"] = vectorJson(shape.extents);
    report["volume"] = shape.volume;
  }
  return report;
}

int countFailed(const WorldBuild& built) {
  const auto has_failed = [](const WorldShapeResult& s) { return s.status == Status::kFailed; };
  return static_cast<int>(std::count_if(built.shapes.begin(), built.shapes.end(), has_failed));
}

/// Prints warnings and failures to standard error, one line each that begins with `input`.
void printTroubles(const WorldBuild& built, const std::string& input) {
  for (const WorldShapeResult& shape : built.shapes) {
    for (const std::string& warning : shape.warnings)
      std::cerr << "warning: " << input << ": " << plainLine(warning) << "\n";
    if (shape.status == Status::kFailed)
      std::cerr << input << ": " << plainLine(shape.message) << "\n";
  }
  if (built.lost_bodies > 0) {
    std::cerr << input << ": " << built.lost_bodies
              << " bodies were left out: Bullet's importer does not know their shape\n";
  }
  if (built.multibodies > 0) {
    std::cerr
        << input << ": " << built.multibodies
        << " multibodies were left out: makeFluidBody makes the fluid bodies of their links\n";
  } else if (built.shapes.empty()) {
    std::cerr << "warning: " << input << ": no body has mass\n";
  }
}

}  // namespace

int buildWorldFile(const BuildArguments& arguments) {
  requireWorldOptions(arguments);
  WorldBuildSettings settings;
  settings.flow.max_panels = arguments.panels;
  settings.flow.threads = arguments.threads;
  settings.tables = !arguments.no_tables;
  settings.holds = holdsOf(arguments.options).is_wanted;
  settings.strict = arguments.options.strict;
  settings.reuse = !arguments.rebuild;
  requireRegularFile(arguments.input, ".bullet");
  requireFolder(arguments.output);
  WorldBuild built;
  {
    std::unique_ptr<ElapsedDisplay> display;
    built = buildWorld(arguments.input, arguments.output, settings, [&](const std::string& shape) {
      display.reset();
      display = std::make_unique<ElapsedDisplay>("building " + shape);
    });
  }
  printTroubles(built, plainLine(arguments.input));
  const int failed = countFailed(built);
  ordered_json shapes = ordered_json::array();
  for (const WorldShapeResult& shape : built.shapes) shapes.push_back(shapeJson(shape));
  std::cout << factsText({{"shapes", shapes},
                          {"failed", failed},
                          {"lost_bodies", built.lost_bodies},
                          {"lost_multibodies", built.multibodies}},
                         arguments.json);
  return failed > 0 || built.lost_bodies > 0 || built.multibodies > 0 ? 1 : 0;
}

}  // namespace ambient
