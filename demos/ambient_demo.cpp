#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "demos/cases_command.h"
#include "demos/scene/scene_lookup.h"
#include "demos/scene/scene_reader.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/output/geometry_text.h"
#include "demos/simulation/output/output_folder.h"
#include "demos/simulation/output/trajectory_text.h"
#include "demos/simulation/run_signals.h"
#include "demos/simulation/scene_run.h"
#include "demos/simulation/summary.h"
#include "preprocess/base/output_file.h"
#include "preprocess/builder/blocked_signals.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/builder/parse_exit.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  bool list = false;
  bool quiet = false;
  std::string scene;
  std::string out;
  FluidLog log;
  std::vector<SceneOverride> overrides;
  CasesArguments cases;
};

/// The arguments, or the exit code if there is nothing more to do.
struct Parsed {
  Arguments arguments;
  std::optional<int> exit_code;
};

void addCasesOptions(CLI::App& app, CasesArguments& cases) {
  auto* file = app.add_option("--cases", cases.cases,
                              "Run many scenes: {\"scene\": ..., \"set\": {PATH: VALUE}} per line")
                   ->type_name("FILE.jsonl");
  app.add_option("--shard", cases.shard, "Of the cases those with index I modulo N (default: 0/1)")
      ->type_name("I/N")
      ->needs(file);
  app.add_option("--threads", cases.threads, "That run cases (default, 0: all cores)")
      ->check(CLI::Range(0, 1024))
      ->needs(file);
  app.add_flag("--summaries", cases.summaries, "Of cases: keep no motion, only summary.json")
      ->needs(file);
  app.add_option("--collect", cases.collect, "Write the table of the cases that are done, and stop")
      ->type_name("FILE.csv")
      ->needs(file);
}

/// One scene, many cases, or the list.
void checkChoice(const Arguments& arguments) {
  const bool has_cases = !arguments.cases.cases.empty();
  const int choices = arguments.list + has_cases + !arguments.scene.empty();
  if (choices != 1) throw CLI::RequiredError("One of SCENE, --cases or --list");
  if (has_cases && arguments.out.empty()) throw CLI::RequiredError("--out (with --cases)");
  if (has_cases && !(arguments.overrides.empty() && arguments.log.isEmpty()))
    throw CLI::ExcludesError("--cases", "--set and --log");
  if (has_cases) checkCases(arguments.cases);
}

Parsed parseArguments(int argc, char** argv) {
  Parsed parsed;
  std::vector<std::string> sets;
  std::string log;
  CLI::App app("Runs a scene of rigid bodies in a fluid inside a Bullet world.", "ambient_demo");
  app.add_flag("--list", parsed.arguments.list, "List the scenes of data/scenes and stop");
  app.add_option("SCENE", parsed.arguments.scene, "A scene's name or the path of a JSON file");
  app.add_option("--out", parsed.arguments.out, "Folder of the results (default: out/<scene>)")
      ->type_name("DIR");
  app.add_option("--set", sets, "Change the scene before it is checked, e.g. bodies.0.mass=0.001")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  app.add_option("--log", log, "Further columns of trajectory.csv: wrench, wet, or both")
      ->type_name("WORDS");
  app.add_flag("--quiet", parsed.arguments.quiet, "Print errors only");
  addCasesOptions(app, parsed.arguments.cases);
  try {
    const std::string empty = emptyArgument(argc, argv);
    if (!empty.empty()) throw std::invalid_argument(empty);
    app.parse(argc, argv);
    for (const std::string& text : sets) parsed.arguments.overrides.push_back(parseOverride(text));
    parsed.arguments.log = parseFluidLog(log);
    checkChoice(parsed.arguments);
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = exitAt(app, error);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "ambient_demo: %s\n", plainLine(error.what()).c_str());
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

/// Files that a run writes, none of them under its name yet.
struct RunFiles {
  explicit RunFiles(const fs::path& out)
      : folder(out),
        trajectory(out / "trajectory.csv"),
        geometry(out / "geometry.json"),
        summary(out / "summary.json") {
    hearSignals({{trajectory.partial(), geometry.partial(), summary.partial()}, folder.made()});
  }

  OutputFolder folder;
  OutputFile trajectory, geometry, summary;

  void commit() {
    trajectory.commit();
    geometry.commit();
    summary.commit();
    folder.keep();
  }
};

/// Signals that come while the files are made arrive when all are known.
RunFiles openFiles(const fs::path& out) {
  const BlockedSignals until_known;
  return RunFiles(out);
}

RunRecord runShown(const Scene& scene, const std::vector<PreparedBody>& bodies,
                   const Arguments& arguments) {
  ElapsedDisplay display(scene.name + ": simulating", arguments.quiet);
  const auto show = [&display](double share) {
    display.update(share);
    return !wasInterrupted();
  };
  return runScene(scene, bodies, show, arguments.log);
}

long long bodiesWithLongSteps(const RunRecord& record) {
  return std::accumulate(
      record.work.begin(), record.work.end(), 0LL,
      [](long long sum, const AmbientCounters& work) { return sum + work.too_long; });
}

void runAndWrite(const Arguments& arguments) {
  const Scene scene = readScene(findScene(arguments.scene, sceneFolders()), arguments.overrides);
  const fs::path out =
      arguments.out.empty() ? "out" / fs::path(scene.name) : fs::path(arguments.out);
  SceneBodyCache cache(out / "fluid_bodies", scene.threads,
                       arguments.quiet ? nullptr : printReport);
  const std::vector<PreparedBody> bodies = prepareBodies(scene, cache);

  // Before, there is nothing to tidy up: signals end the program at once.
  RunFiles files = openFiles(out);
  files.geometry.write(makeGeometryText(scene, bodies));
  const RunRecord record = runShown(scene, bodies, arguments);
  files.trajectory.write(
      makeTrajectoryText(scene, record.motion, fluidLogHeader(arguments.log), record.log));
  files.summary.write(makeSummary(scene, bodies, record));
  {
    const BlockedSignals until_all_have_their_names;
    files.commit();
    cache.save();
  }
  if (!arguments.quiet) {
    std::istringstream sentences(record.warning);
    for (std::string sentence; std::getline(sentences, sentence);)
      std::fprintf(stderr, "warning: %s\n", plainLine(sentence).c_str());
    if (const long long count = bodiesWithLongSteps(record); count > 0)
      std::fprintf(stderr, "warning: steps were too long for the motion of %lld of %zu bodies\n",
                   count, record.work.size());
    std::printf("%s: %lld steps in %.2f s; wrote trajectory.csv and summary.json to %s\n",
                plainLine(scene.name).c_str(), record.steps, record.wall_seconds,
                plainLine(files.folder.path().string()).c_str());
  }
}

CasesArguments casesOf(const Arguments& arguments) {
  CasesArguments cases = arguments.cases;
  cases.out = arguments.out;
  cases.quiet = arguments.quiet;
  return cases;
}

int run(int argc, char** argv) {
  const Parsed parsed = parseArguments(argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  if (parsed.arguments.list)
    printScenes();
  else if (!parsed.arguments.cases.cases.empty())
    return runCasesCommand(casesOf(parsed.arguments)) ? 0 : kBadInput;
  else
    runAndWrite(parsed.arguments);
  return 0;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  return ambient::runProgram("ambient_demo", [&] { return ambient::run(argc, argv); });
}
