#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/plain_text.h"
#include "preprocess/command_line/closest_word.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/waterline/waterline_builder.h"

namespace ambient {
namespace {

constexpr int kBadInput = 1;
constexpr int kBadUsage = 2;

/// --sheet, --hull and --wrap [SIZE], which say what a mesh stands for.
template <class Arguments>
void addMeshOptions(CLI::App& command, Arguments& arguments) {
  command.add_flag("--sheet", arguments.sheet, "The mesh is an open surface of zero thickness");
  command.add_flag("--hull", arguments.hull, "Take the convex hull of the mesh");
  command
      .add_option_function<std::string>(
          "--wrap", [&arguments](const std::string& size) { arguments.wrap = size; },
          "Take a closed surface around the mesh, which may be open, overlapping, or in parts; "
          "gaps "
          "and details below SIZE vanish (default 1/100 of its diagonal)")
      ->type_name("[SIZE]");
}

/// How the flow around a mesh is solved.
void addFlowOptions(CLI::App& build, BuildArguments& arguments) {
  build
      .add_option("--panels", arguments.panels,
                  "Panels for the flow, at most; the faces stay those of the mesh (default 4200; "
                  "0: the triangles of the mesh)")
      ->type_name("N");
  build.add_option("--threads", arguments.threads, "0: all cores (default)")->type_name("N");
  build
      .add_option("--solver", arguments.solver,
                  "dense or hierarchical (default: hierarchical above 4200 panels)")
      ->type_name("KIND");
  build
      .add_option("--memory", arguments.memory,
                  "For the flow, at most (default: what the machine has available)")
      ->type_name("GB");
  build
      .add_flag("--waterline-table{" + std::to_string(kDefaultWaterlineSubdivisions) + "}",
                arguments.waterline,
                "Solve the flow at the surface of water too, in attitudes of 4 N^2 + 2 "
                "directions (default none; without =N: 4)")
      ->type_name("N");
  build.add_flag("--no-tables", arguments.no_tables,
                 "Solve the flow around boxes, cylinders, capsules and cones too");
}

CLI::App* addBuild(CLI::App& app, BuildArguments& arguments) {
  CLI::App* build = app.add_subcommand("build", "Makes an .ambient file from a mesh or a shape");
  build
      ->add_option(
          "INPUT", arguments.input,
          "A mesh (OBJ, STL, PLY, glTF, ...), a JSON file with a shape, or a .bullet world")
      ->required();
  build
      ->add_option("-o,--output", arguments.output,
                   "The .ambient file to write, of a world: the folder for them")
      ->required()
      ->type_name("OUT.ambient");
  build->add_option("--scale", arguments.scale, "Multiplies all lengths (default 1)")
      ->type_name("S");
  build
      ->add_option("--origin", arguments.origin,
                   "Origin of the body frame in the mesh's frame (default centre-of-volume)")
      ->type_name("centre-of-volume|X,Y,Z");
  addMeshOptions(*build, arguments);
  build
      ->add_option("--least-faces", arguments.least_faces,
                   "Divide the mesh into at least so many faces (default 0: faces as they are)")
      ->type_name("N");
  build
      ->add_option("--levels", arguments.levels,
                   "Levels of reduced loads, of so many clusters each (default none)")
      ->delimiter(',')
      ->type_name("N,N,...");
  build
      ->add_option("--drag", arguments.drag,
                   "Measured drag coefficients along the axes, on the frontal areas, that the form "
                   "law is scaled to (default none)")
      ->delimiter(',')
      ->type_name("C[,C,C]");
  build
      ->add_option("--separation-angle", arguments.separation_angle,
                   "For which the levels are fitted (default pi/2)")
      ->type_name("RAD");
  addFlowOptions(*build, arguments);
  build->add_flag("--no-margins", arguments.no_margins,
                  "Worlds: convex hulls and cones without their margins");
  build->add_flag("--rebuild", arguments.rebuild, "Build also where nothing has changed");
  build->add_flag("--json", arguments.json, "Print one JSON object instead of a table");
  return build;
}

CLI::App* addCheck(CLI::App& app, CheckArguments& arguments) {
  CLI::App* check = app.add_subcommand(
      "check", "Finds all defects of a mesh, and what would mend them, without solving");
  check->add_option("INPUT", arguments.input, "A mesh, or a JSON file with one")->required();
  check->add_option("--scale", arguments.scale, "Multiplies all lengths (default 1)")
      ->type_name("S");
  addMeshOptions(*check, arguments);
  check->add_option("--obj", arguments.obj, "Write the triangles of the defects into this file")
      ->type_name("OUT.obj");
  check->add_flag("--json", arguments.json, "Print one JSON object instead of a table");
  return check;
}

CLI::App* addInspect(CLI::App& app, InspectArguments& arguments) {
  CLI::App* inspect = app.add_subcommand("inspect", "Shows what an .ambient file holds");
  inspect->add_option("FILE", arguments.file, "An .ambient file")->required();
  inspect->add_option("--mass", arguments.mass, "Shows how a body of this mass floats [kg]");
  inspect
      ->add_option("--centre-of-mass", arguments.centre_of_mass,
                   "With --mass: in the body's frame [m]; default: that of a mass spread evenly")
      ->expected(3)
      ->type_name("X Y Z");
  inspect->add_option("--density", arguments.density, "With --mass: of the water [kg/m^3]")
      ->capture_default_str();
  inspect->add_option("--gravity", arguments.gravity, "With --mass: [m/s^2]")
      ->capture_default_str();
  inspect->add_flag("--json", arguments.json, "Print one JSON object instead of a table");
  return inspect;
}

CLI::App* addLoads(CLI::App& app, LoadsArguments& arguments) {
  CLI::App* loads = app.add_subcommand(
      "loads", "Evaluates pressure and friction for one motion relative to the fluid");
  loads->add_option("FILE", arguments.file, "An .ambient file")->required();
  loads
      ->add_option("--twist", arguments.twist,
                   "Angular and linear velocity of the body frame's origin, body axes [rad/s, m/s]")
      ->required()
      ->type_name("WX WY WZ VX VY VZ");
  loads->add_option("--density", arguments.density, "Of the fluid [kg/m^3]")
      ->required()
      ->type_name("RHO");
  loads
      ->add_option("--viscosity", arguments.viscosity,
                   "Dynamic viscosity [Pa s] (default 0: no friction)")
      ->type_name("MU");
  loads
      ->add_option("--separation-angle", arguments.separation_angle,
                   "From pi/2 (default) to pi; larger = more attachment")
      ->type_name("RAD");
  loads->add_option("--law", arguments.law, "Of the pressure: published (default) or form")
      ->type_name("LAW");
  loads->add_flag("--no-friction", arguments.no_friction, "Leave skin friction out");
  loads->add_flag("--json", arguments.json, "Print one JSON object instead of a table");
  return loads;
}

CLI::App* addPolar(CLI::App& app, PolarArguments& arguments) {
  CLI::App* polar = app.add_subcommand(
      "polar", "Coefficients of lift, drag and moment against the angles of the flow, as CSV");
  const auto option = [&](const char* name, auto& value, const char* text, const char* type) {
    polar->add_option(name, value, text)->type_name(type);
  };
  polar->add_option("FILE", arguments.file, "An .ambient file")->required();
  option("--attack", arguments.attack, "Angle of attack in degrees (default -90:90:5)",
         "FROM:TO:STEP");
  option("--side-slip", arguments.side_slip, "Angle of side-slip in degrees (default 0)",
         "FROM:TO:STEP");
  option("--forward", arguments.forward, "The body's forward axis (default x)", "AXIS");
  option("--up", arguments.up, "The body's upward axis (default z)", "AXIS");
  option("--density", arguments.density, "Of the fluid [kg/m^3] (default 1)", "RHO");
  option("--speed", arguments.speed, "[m/s] (default 1); matters with viscosity only", "V");
  option("--viscosity", arguments.viscosity, "Dynamic viscosity [Pa s] (default 0: no friction)",
         "MU");
  option("--separation-angle", arguments.separation_angle, "From pi/2 (default) to pi", "RAD");
  option("--law", arguments.law, "Of the pressure: published (default) or form", "LAW");
  option("--reference-area", arguments.reference_area,
         "[m^2] (default: half the area projected along --up)", "A");
  option("--reference-length", arguments.reference_length, "[m] (default: extent along --forward)",
         "L");
  return polar;
}

CLI::App* addCompare(CLI::App& app, CompareArguments& arguments) {
  CLI::App* compare =
      app.add_subcommand("compare", "Relative differences of two .ambient files; status 1 if any");
  compare->add_option("A", arguments.first, "An .ambient file")->required();
  compare->add_option("B", arguments.second, "Another one")->required();
  compare->add_option("--tolerance", arguments.tolerance, "Relative (default 1e-6)")
      ->type_name("T");
  compare->add_option("--law", arguments.law, "Of the pressure: published (default) or form")
      ->type_name("LAW");
  compare->add_flag("--json", arguments.json, "Print one JSON object instead of a table");
  return compare;
}

CLI::App* addReport(CLI::App& app, ReportArguments& arguments) {
  CLI::App* report = app.add_subcommand(
      "report", "Estimates the error of a mesh and shows its thinnest part and worst triangles");
  report->add_option("INPUT", arguments.input, "A mesh, or a JSON file with a shape")->required();
  report->add_option("--scale", arguments.scale, "Multiplies all lengths (default 1)")
      ->type_name("S");
  report->add_flag("--sheet", arguments.sheet, "The mesh is an open surface of zero thickness");
  report
      ->add_option("--picture", arguments.picture,
                   "Also draw the potential on the surface into this file")
      ->type_name("OUT.svg");
  report->add_option("--panels", arguments.panels, "As for build (default 4200)")->type_name("N");
  report->add_option("--threads", arguments.threads, "0: all cores (default)")->type_name("N");
  report->add_flag("--json", arguments.json, "Print one JSON object instead of a table");
  return report;
}

int exitAt(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream errors;
  const int code = app.exit(error, std::cout, errors);
  std::cerr << plainText(errors.str());
  return code == 0 ? 0 : kBadUsage;
}

/// A sentence about an argument without letters, which CLI11 takes for 0 where it should be a
/// number: mostly a variable of the shell that is not set.
std::string emptyArgument(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (*argv[i] == '\0') return "argument " + std::to_string(i) + " is empty";
  }
  return {};
}

/// A sentence about a first word that is no command, if there is one.
std::string unknownCommand(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  const std::string word = argv[1];
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return {};
  const std::string closest = closestWord(word, names);
  return "unknown command '" + word + "'" +
         (closest.empty() ? "; --help lists them" : "; did you mean '" + closest + "'?");
}

/// The arguments, last one first as CLI11 wants them; --wrap takes a number that follows, and
/// nothing else.
std::vector<std::string> argumentsOf(int argc, char** argv) {
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) {
    arguments.emplace_back(argv[i]);
    if (arguments.back() != "--wrap") continue;
    char* end = nullptr;
    const bool has_size = i + 1 < argc && (std::strtod(argv[i + 1], &end), *end == '\0');
    arguments.back() += std::string("=") + (has_size ? argv[++i] : kDefaultWrap);
  }
  std::reverse(arguments.begin(), arguments.end());
  return arguments;
}

int run(int argc, char** argv) {
  CLI::App app("Makes, shows and evaluates .ambient files: what a fluid needs to know of a shape.",
               "ambient_preprocess");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("ambient_preprocess ") + AMBIENT_VERSION);
  BuildArguments build_arguments;
  InspectArguments inspect_arguments;
  LoadsArguments loads_arguments;
  const CLI::App* build = addBuild(app, build_arguments);
  CheckArguments check_arguments;
  const CLI::App* check = addCheck(app, check_arguments);
  const CLI::App* inspect = addInspect(app, inspect_arguments);
  const CLI::App* loads = addLoads(app, loads_arguments);
  PolarArguments polar_arguments;
  CompareArguments compare_arguments;
  ReportArguments report_arguments;
  const CLI::App* report = addReport(app, report_arguments);
  const CLI::App* polar = addPolar(app, polar_arguments);
  const CLI::App* compare = addCompare(app, compare_arguments);
  for (const std::string& message : {emptyArgument(argc, argv), unknownCommand(app, argc, argv)}) {
    if (message.empty()) continue;
    std::cerr << "ambient_preprocess: " << plainLine(message) << "\n";
    return kBadUsage;
  }
  try {
    app.parse(argumentsOf(argc, argv));
  } catch (const CLI::ParseError& error) {
    return exitAt(app, error);
  }
  try {
    if (build->parsed()) return runBuild(build_arguments);
    if (check->parsed()) return runCheck(check_arguments);
    if (inspect->parsed()) runInspect(inspect_arguments);
    if (loads->parsed()) runLoads(loads_arguments);
    if (report->parsed()) runReport(report_arguments);
    if (polar->parsed()) runPolar(polar_arguments);
    if (compare->parsed()) return runCompare(compare_arguments);
  } catch (const UsageError& error) {
    std::cerr << "ambient_preprocess: " << plainLine(error.what()) << "\n";
    return kBadUsage;
  } catch (const std::bad_alloc&) {
    std::cerr << "ambient_preprocess: there is not enough memory for an input of this size\n";
    return kBadInput;
  } catch (const std::exception& error) {
    std::cerr << "ambient_preprocess: " << plainLine(error.what()) << "\n";
    return kBadInput;
  }
  return 0;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  // Beyond a limit of the file size, writing fails with a message in place of ending the program.
  std::signal(SIGXFSZ, SIG_IGN);
  const int exit_code = ambient::run(argc, argv);
  std::cout.flush();
  if (exit_code == 0 && (!std::cout || std::fflush(stdout) != 0)) {
    std::cerr << "ambient_preprocess: the result cannot be written to standard output\n";
    return ambient::kBadInput;
  }
  return exit_code;
}
