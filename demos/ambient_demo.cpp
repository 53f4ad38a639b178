#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/output_file.h"
#include "demos/gltf/gltf_text.h"
#include "demos/scene/scene_lookup.h"
#include "demos/scene/scene_reader.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/geometry_text.h"
#include "demos/simulation/output_folder.h"
#include "demos/simulation/run_signals.h"
#include "demos/simulation/scene_run.h"
#include "demos/simulation/summary.h"
#include "preprocess/builder/blocked_signals.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/mesh/plain_text.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 1;
constexpr int kBadUsage = 2;

struct Arguments {
  bool list = false;
  bool quiet = false;
  std::string scene;
  std::string out;
  std::string gltf;
  std::vector<SceneOverride> overrides;
};

/// The arguments, or the exit code if there is nothing more to do.
struct Parsed {
  Arguments arguments;
  std::optional<int> exit_code;
};

Parsed parseArguments(int argc, char** argv) {
  Parsed parsed;
  std::vector<std::string> sets;
  CLI::App app("Runs a scene of rigid bodies in a fluid inside a Bullet world.", "ambient_demo");
  app.add_flag("--list", parsed.arguments.list, "List the scenes of data/scenes and stop");
  app.add_option("SCENE", parsed.arguments.scene, "A scene's name or the path of a JSON file");
  app.add_option("--out", parsed.arguments.out, "Folder of the results (default: out/<scene>)")
      ->type_name("DIR");
  app.add_option("--set", sets, "Change the scene before it is checked, e.g. bodies.0.mass=0.001")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  app.add_option("--gltf", parsed.arguments.gltf, "Write an animated glTF too (.glb or .gltf)")
      ->type_name("FILE")
      ->check([](const std::string& file) {
        return isGltfName(file) ? "" : file + ": the name must end in .glb or .gltf";
      });
  app.add_flag("--quiet", parsed.arguments.quiet, "Print errors only");
  try {
    app.parse(argc, argv);
    for (const std::string& text : sets) parsed.arguments.overrides.push_back(parseOverride(text));
    if (parsed.arguments.scene.empty() && !parsed.arguments.list)
      throw CLI::RequiredError("SCENE or --list");
  } catch (const CLI::ParseError& error) {
    std::ostringstream errors;
    parsed.exit_code = app.exit(error, std::cout, errors) == 0 ? 0 : kBadUsage;
    std::cerr << plainText(errors.str());
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n", plainLine(error.what()).c_str());
    parsed.exit_code = kBadUsage;
  }
  return parsed;
}

void printScenes() {
  for (const fs::path& file : listScenes(sceneFolders())) {
    std::string description;
    try {
      description = readScene(file).description;
    } catch (const std::exception& error) {
      description = std::string("not readable: ") + error.what();
    }
    std::printf("%-24s %s\n", plainLine(file.stem().string()).c_str(),
                plainLine(description).c_str());
  }
}

std::vector<PreparedBody> prepare(const Scene& scene, SceneBodyCache& cache, bool quiet) {
  const ElapsedDisplay display(scene.name + ": preparing bodies", quiet);
  return prepareBodies(scene, cache);
}

/// What a run writes, none of it under its name yet.
struct RunFiles {
  RunFiles(const fs::path& out, const std::string& gltf_file)
      : folder(out),
        trajectory(out / "trajectory.csv"),
        geometry(out / "geometry.json"),
        summary(out / "summary.json") {
    if (!gltf_file.empty()) gltf.emplace(gltf_file);
    Unfinished unfinished{{trajectory.partial(), geometry.partial(), summary.partial()},
                          folder.made()};
    if (gltf) unfinished.files.push_back(gltf->partial());
    hearSignals(unfinished);
  }

  OutputFolder folder;
  OutputFile trajectory, geometry, summary;
  std::optional<OutputFile> gltf;

  void commit() {
    trajectory.commit();
    geometry.commit();
    summary.commit();
    if (gltf) gltf->commit();
    folder.keep();
  }
};

/// Signals that come while the files are made arrive when all are known.
RunFiles openFiles(const fs::path& out, const std::string& gltf) {
  const BlockedSignals until_known;
  return RunFiles(out, gltf);
}

void runAndWrite(const Arguments& arguments) {
  const Scene scene = readScene(findScene(arguments.scene, sceneFolders()), arguments.overrides);
  const fs::path out =
      arguments.out.empty() ? "out" / fs::path(scene.name) : fs::path(arguments.out);
  SceneBodyCache cache(out / "fluid_bodies", scene.threads);
  const std::vector<PreparedBody> bodies = prepare(scene, cache, arguments.quiet);
  for (const std::string& warning : cache.warnings())
    if (!arguments.quiet) std::fprintf(stderr, "warning: %s\n", plainLine(warning).c_str());

  // Before, there is nothing to tidy up: signals end the program at once.
  RunFiles files = openFiles(out, arguments.gltf);
  files.geometry.write(makeGeometryText(scene, bodies));
  const RunRecord record = runScene(scene, bodies, files.trajectory, arguments.quiet);
  files.summary.write(makeSummary(scene, bodies, record));
  if (files.gltf) files.gltf->write(makeGltf(arguments.gltf, scene, bodies, record.motion));
  {
    const BlockedSignals until_all_have_their_names;
    files.commit();
    cache.save();
  }
  if (!record.warning.empty() && !arguments.quiet)
    std::fprintf(stderr, "warning: %s\n", plainLine(record.warning).c_str());
  if (!arguments.quiet)
    std::printf("%s: %lld steps in %.2f s; wrote trajectory.csv and summary.json to %s\n",
                plainLine(scene.name).c_str(), record.steps, record.wall_seconds,
                plainLine(files.folder.path().string()).c_str());
}

int run(int argc, char** argv) {
  const Parsed parsed = parseArguments(argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  try {
    if (parsed.arguments.list)
      printScenes();
    else
      runAndWrite(parsed.arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ambient_demo: %s\n", plainLine(error.what()).c_str());
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
  if (exit_code == 0 && std::fflush(stdout) != 0) {
    std::fprintf(stderr, "ambient_demo: cannot write to standard output\n");
    return ambient::kBadInput;
  }
  return exit_code;
}
