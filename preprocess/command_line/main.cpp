#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "preprocess/command_line/commands.h"

namespace ambient {
namespace {

constexpr int kBadInput = 1;
constexpr int kBadUsage = 2;

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
  build->add_flag("--sheet", arguments.sheet, "The mesh is an open surface of zero thickness");
  build
      ->add_option("--least-faces", arguments.least_faces,
                   "Divide the mesh into at least so many faces (default 0: faces as they are)")
      ->type_name("N");
  build
      ->add_option("--panels", arguments.panels,
                   "Panels for the flow, at most; the faces stay those of the mesh (default 4200; "
                   "0: the triangles of the mesh)")
      ->type_name("N");
  build->add_option("--threads", arguments.threads, "0: all cores (default)")->type_name("N");
  build->add_flag("--no-margins", arguments.no_margins,
                  "Worlds: convex hulls and cones without their margins");
  build->add_flag("--rebuild", arguments.rebuild, "Build also where nothing has changed");
  build->add_flag("--json", arguments.json, "Print one JSON object instead of a table");
  return build;
}

CLI::App* addInspect(CLI::App& app, InspectArguments& arguments) {
  CLI::App* inspect = app.add_subcommand("inspect", "Shows what an .ambient file holds");
  inspect->add_option("FILE", arguments.file, "An .ambient file")->required();
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
  loads->add_flag("--no-friction", arguments.no_friction, "Leave skin friction out");
  loads->add_flag("--json", arguments.json, "Print one JSON object instead of a table");
  return loads;
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
  const CLI::App* inspect = addInspect(app, inspect_arguments);
  const CLI::App* loads = addLoads(app, loads_arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadUsage;
  }
  try {
    if (build->parsed()) return runBuild(build_arguments);
    if (inspect->parsed()) runInspect(inspect_arguments);
    if (loads->parsed()) runLoads(loads_arguments);
  } catch (const std::exception& error) {
    std::cerr << "ambient_preprocess: " << error.what() << "\n";
    return kBadInput;
  }
  return 0;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) { return ambient::run(argc, argv); }
