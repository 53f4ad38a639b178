#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "bullet_ambient/base/plain_text.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/builder/parse_exit.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/polar/polar.h"
#include "preprocess/reduced_loads/form_levels.h"
#include "preprocess/waterline/waterline_builder.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

std::optional<Eigen::Vector3d> parseOrigin(const std::string& text) {
  if (text == "centre-of-volume") return std::nullopt;
  std::istringstream stream(text);
  Eigen::Vector3d origin;
  char comma_1 = 0, comma_2 = 0;
  stream >> origin.x() >> comma_1 >> origin.y() >> comma_2 >> origin.z();
  const bool is_point = !stream.fail() && comma_1 == ',' && comma_2 == ',' &&
                        stream.peek() == std::istringstream::traits_type::eof();
  if (!is_point || !origin.allFinite()) {
    raiseUsageError("--origin", "\"", text, "\" is neither centre-of-volume nor three finite ",
                    "numbers X,Y,Z");
  }
  return origin;
}

/// Holds that are found and given.
HoldSearch holdsOf(const BuildArguments& arguments) {
  constexpr std::size_t kNumbers = 7;  // x, y, z, area, normal
  HoldSearch search = holdsOf(arguments.options);
  search.tanks.assign(arguments.tanks.begin(), arguments.tanks.end());
  const std::vector<double>& numbers = arguments.openings;
  if (numbers.size() % kNumbers != 0)
    raiseUsageError("--opening", numbers.size(), " numbers are not X Y Z AREA NX NY NZ");
  for (std::size_t i = 0; i < numbers.size(); i += kNumbers) {
    const Eigen::Map<const Eigen::Matrix<double, kNumbers, 1>> opening(&numbers[i]);
    search.openings.push_back({opening.head<3>(), opening.tail<3>(), opening[3]});
  }
  return search;
}

ShapeBuildSettings settingsOf(const BuildArguments& arguments) {
  ShapeBuildSettings settings;
  settings.name = fs::path(arguments.input).stem().string();
  settings.origin = parseOrigin(arguments.origin);
  settings.scale = arguments.options.scale;
  settings.holds = holdsOf(arguments);
  settings.least_faces = arguments.least_faces;
  settings.flow.max_panels = arguments.panels;
  settings.flow.threads = arguments.threads;
  settings.tables = !arguments.no_tables;
  settings.wings = arguments.wings;
  settings.waterline_subdivisions = arguments.waterline;
  return settings;
}

/// One number holds for all axes.
Vector3 dragOf(const BuildArguments& arguments) {
  const std::vector<double>& drag = arguments.drag;
  if (drag.empty()) return Vector3::Zero();
  if (drag.size() != 1 && drag.size() != 3)
    raiseUsageError("--drag", drag.size(), " numbers are neither one nor three");
  for (const double coefficient : drag) {
    requirePositive("--drag", coefficient);
    if (coefficient > kLargestDrag)
      raiseUsageError("--drag", coefficient, " is above ", kLargestDrag);
  }
  return {drag.front(), drag[drag.size() / 2], drag.back()};
}

Provenance describeBody(const ShapeDescription& shape, const ShapeBuildSettings& settings,
                        const BuildArguments& arguments) {
  Provenance provenance = describeShape(shape, settings);
  std::ostringstream text;
  text.precision(17);
  for (const int faces : arguments.levels) text << (text.tellp() == 0 ? "; levels " : ",") << faces;
  if (!arguments.drag.empty()) text << "; drag " << dragOf(arguments).transpose();
  provenance.settings += text.str();
  return provenance;
}

FluidBody buildAndWrite(const ShapeDescription& shape, ShapeBuildSettings settings,
                        const BuildArguments& arguments) {
  BuiltBody built;
  {
    ElapsedDisplay display("building " + settings.name);
    settings.begin = [&display](const std::string& stage) { display.begin(stage); };
    built = buildShape(shape, settings);
    display.begin("reducing the loads");
    if (built.body.sphere_radius > 0 && !arguments.drag.empty())
      raiseInputError(arguments.input,
                      "--drag needs faces: a sphere has the loads of a smooth one");
    if (!arguments.drag.empty()) setMeasuredDrag(dragOf(arguments), built.body);
    if (!built.body.wings.empty() && !arguments.levels.empty())
      raiseUsageError("--levels", "a body with wings has none: its parts have few faces");
    built.body.form_levels = buildFormLevels(built.body, arguments.levels);
    built.body.provenance.settings = describeBody(shape, settings, arguments).settings;
  }
  const BlockedSignals until_renamed;
  writeFluidBody(built.body, arguments.output);
  return built.body;
}

void requireValues(const BuildArguments& arguments) {
  requirePositive("--scale", arguments.options.scale);
  requireDivisions("--least-faces", arguments.least_faces);
  requireDivisions("--panels", arguments.panels);
  requireThreads(arguments.threads);
  if (arguments.waterline < 0 || arguments.waterline > kMostWaterlineSubdivisions)
    raiseUsageError("--waterline-table", "its N is not between 1 and ", kMostWaterlineSubdivisions);
  for (const int faces : arguments.levels) {
    if (faces < kFewestLevelFaces || faces > kMostLevelFaces)
      raiseUsageError("--levels", faces, " faces are not ", kFewestLevelFaces, " to ",
                      kMostLevelFaces);
  }
  dragOf(arguments);
}

/// Returns the exit status.
int runBuild(const BuildArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  requireValues(arguments);
  if (hasExtension(arguments.input, ".bullet")) return buildWorldFile(arguments);
  const ShapeBuildSettings settings = settingsOf(arguments);
  const ShapeDescription shape = describeInput(arguments.input, arguments.options);
  requireWritablePlace(arguments.output, arguments.input);
  requireReplaceable(arguments.output);
  std::optional<FluidBody> body;
  if (!arguments.rebuild) {
    body = readIfSame(arguments.output, settings.name, describeBody(shape, settings, arguments));
  }
  const bool is_reused = body.has_value();
  if (!body) body = buildAndWrite(shape, settings, arguments);
  for (const std::string& warning : body->provenance.said)
    std::cerr << "warning: " << plainLine(warning) << "\n";
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (is_reused && !arguments.json) {
    std::cerr << plainLine(arguments.output) << ": nothing has changed since it was built\n";
  }
  nlohmann::ordered_json facts = bodyFacts(*body);
  if (arguments.json) facts["seconds"] = seconds.count();
  std::cout << factsText(facts, arguments.json);
  return 0;
}

/// Options of how the flow around a mesh is solved.
void addFlowOptions(CLI::App& command, BuildArguments& arguments) {
  addOption(command, "--panels", arguments.panels, "N",
            "Panels for the flow, at most; the faces stay those of the mesh (default 4200; "
            "0: the triangles of the mesh)");
  addOption(command, "--threads", arguments.threads, "N", "0: all cores (default)");
  command
      .add_flag("--waterline-table{" + std::to_string(kDefaultWaterlineSubdivisions) + "}",
                arguments.waterline,
                "Solve the flow at the surface of water too, in attitudes of 4 N^2 + 2 "
                "directions (default none; without =N: 4)")
      ->type_name("N");
  command.add_flag("--no-tables", arguments.no_tables,
                   "Solve the flow around boxes, cylinders, capsules and cones too");
}

/// Options of what the body is made of and what is fitted to it.
void addBodyOptions(CLI::App& command, BuildArguments& arguments) {
  addInputOptions(command, arguments.options);
  addOption(command, "--origin", arguments.origin, "centre-of-volume|X,Y,Z",
            "Origin of the body frame in the mesh's frame (default centre-of-volume)");
  addOption(command, "--least-faces", arguments.least_faces, "N",
            "Divide the mesh into at least so many faces (default 0: faces as they are)");
  addOption(command, "--levels", arguments.levels, "N,N,...",
            "Sets of so many faces that stand for all in the form law (default none)")
      ->delimiter(',');
  addOption(
      command, "--wings", arguments.wings, "none|auto|FILE",
      "Parts that lift where they are: by the names of nodes in the mesh file, else found; or "
      "as a JSON file lists them (default none)");
  addOption(command, "--tank", arguments.tanks, "FILE",
            "A closed mesh in the walls or in a cavity that is a hold without openings; may be "
            "repeated")
      ->allow_extra_args(false);
  addOption(command, "--opening", arguments.openings, "X Y Z AREA NX NY NZ",
            "A hole in the nearest wall of a hold: place [m], area [m^2], direction out of the "
            "hold; may be repeated")
      ->type_size(7)
      ->expected(1, CLI::detail::expected_max_vector_size)
      ->allow_extra_args(false);
  addOption(command, "--drag", arguments.drag, "C[,C,C]",
            "Measured drag coefficients along the axes, on the frontal areas, that the drag of the "
            "form law is scaled to (default none)")
      ->delimiter(',');
}

}  // namespace

#if !defined(AMBIENT_READS_WORLDS)
int buildWorldFile(const BuildArguments& arguments) {
  raiseInputError(arguments.input,
                  "this program was built without Bullet's world importer (Debian: "
                  "libbullet-extras-dev) and reads no .bullet files");
}
#endif

void addBuild(CLI::App& app) {
  const auto arguments = std::make_shared<BuildArguments>();
  CLI::App& command = *app.add_subcommand("build", "Makes an .ambient file from a mesh or a shape");
  command
      .add_option("INPUT", arguments->input,
                  "A mesh (OBJ, STL, PLY, glTF, ...), a JSON file with a shape, or a .bullet world")
      ->required();
  addOption(command, "-o,--output", arguments->output, "OUT.ambient",
            "The .ambient file to write, of a world: the folder for them")
      ->required();
  addBodyOptions(command, *arguments);
  addFlowOptions(command, *arguments);
  command.add_flag("--rebuild", arguments->rebuild, "Build also where nothing has changed");
  addJson(command, arguments->json);
  command.callback([arguments] {
    if (const int status = runBuild(*arguments); status != 0) throw CLI::RuntimeError(status);
  });
}

}  // namespace ambient
