#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/bullet_world/world_file.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/command_line/commands/build_arguments.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

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

CollisionShapeSettings shapeSettingsOf(const BuildArguments& arguments) {
  CollisionShapeSettings settings;
  settings.flow.max_panels = arguments.panels;
  settings.flow.threads = arguments.threads;
  settings.tables = !arguments.no_tables;
  settings.holds = holdsOf(arguments.options).is_wanted;
  settings.strict = arguments.options.strict;
  return settings;
}

/// Makes folder/<name>.ambient of a shape, or keeps it if it is still right. Prints warnings and
/// failures to standard error, one line each that begins with the input; a shape that fails leaves
/// its file as it was.
ordered_json buildShapeFile(const WorldShape& shape, CollisionShapeSettings settings,
                            const BuildArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const fs::path file = fs::path(arguments.output) / (shape.name + ".ambient");
  std::optional<FluidBody> kept, body;
  std::string failure;
  std::vector<std::string> warnings;
  settings.name = shape.name;
  settings.report = [&](const std::string& text) { warnings.push_back(text); };
  try {
    const ElapsedDisplay display("building " + shape.name);
    const Provenance provenance = describeCollisionShape(*shape.shape, settings);
    if (!arguments.rebuild) kept = readIfSame(file, shape.name, provenance);
    body = kept ? kept : makeFluidBody(*shape.shape, settings);
    if (!kept) writeFluidBody(*body, file);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const std::string input = plainLine(arguments.input) + ": ";
  for (const std::string& warning : warnings)
    std::cerr << "warning: " << input << plainLine(warning) << "\n";
  if (!failure.empty()) std::cerr << input << plainLine(failure) << "\n";
  ordered_json facts{{"name", shape.name},
                     {"file", file.string()},
                     {"status", !failure.empty() ? "failed"
                                : kept           ? "kept"
                                                 : "built"},
                     {"bodies", shape.bodies},
                     {"seconds", seconds.count()}};
  if (!failure.empty()) {
    facts["message"] = failure;
  } else {
    facts["faces"] = body->faces.size();
    facts["size"] = vectorJson(extentsOf(*body));
    facts["volume"] = body->volume;
  }
  return facts;
}

/// Prints what a world has besides shapes to standard error.
void printLost(const WorldFile& world, const std::string& input) {
  if (world.lostBodies() > 0) {
    std::cerr << input << ": " << world.lostBodies()
              << " bodies were left out: Bullet's importer does not know their shape\n";
  }
  if (world.multibodies() > 0) {
    std::cerr
        << input << ": " << world.multibodies()
        << " multibodies were left out: makeFluidBody makes the fluid bodies of their links\n";
  } else if (world.dynamicShapes().empty()) {
    std::cerr << "warning: " << input << ": no body has mass\n";
  }
}

}  // namespace

int buildWorldFile(const BuildArguments& arguments) {
  requireWorldOptions(arguments);
  const CollisionShapeSettings settings = shapeSettingsOf(arguments);
  requireRegularFile(arguments.input, ".bullet");
  requireFolder(arguments.output);
  const WorldFile world(arguments.input);
  std::error_code no_folder;
  fs::create_directories(arguments.output, no_folder);
  if (no_folder)
    raiseInputError(arguments.output, "the folder cannot be made: ", no_folder.message());
  ordered_json shapes = ordered_json::array();
  int failed = 0;
  for (const WorldShape& shape : world.dynamicShapes()) {
    shapes.push_back(buildShapeFile(shape, settings, arguments));
    failed += shapes.back()["status"] == "failed" ? 1 : 0;
  }
  printLost(world, plainLine(arguments.input));
  std::cout << factsText({{"shapes", shapes},
                          {"failed", failed},
                          {"lost_bodies", world.lostBodies()},
                          {"lost_multibodies", world.multibodies()}},
                         arguments.json);
  return failed > 0 || world.lostBodies() > 0 || world.multibodies() > 0 ? 1 : 0;
}

}  // namespace ambient
