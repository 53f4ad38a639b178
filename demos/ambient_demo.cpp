#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "demos/scene/scene_reader.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/output/run_files.h"
#include "demos/simulation/scene_run.h"
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
};

/// The arguments, or the exit code if there is nothing more to do.
struct Parsed {
  Arguments arguments;
  std::optional<int> exit_code;
};

bool isCases(const char* argument) {
  return std::strncmp(argument, "--cases", std::strlen("--cases")) == 0;
}

/// Becomes `python3 -m bullet_ambient` with the same arguments, which runs files of cases.
/// @throws std::runtime_error in one line if there is no Python module, or no Python
[[noreturn]] void runCases(int argc, char** argv) {
  if (*AMBIENT_PYTHON == '\0')
    throw std::runtime_error(
        "ambient_demo: --cases needs the Python module: build with -DBULLET_AMBIENT_PYTHON=ON, or "
        "where it is installed, python3 -m bullet_ambient --cases FILE.jsonl --out DIR");
  std::vector<std::string> words{AMBIENT_PYTHON, "-m", "bullet_ambient"};
  words.insert(words.end(), argv + 1, argv + argc);
  const char* others = std::getenv("PYTHONPATH");
  const std::string path = AMBIENT_PYTHON_PATH + (others ? ":" + std::string(others) : "");
  ::setenv("PYTHONPATH", path.c_str(), 1);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(AMBIENT_PYTHON, arguments.data());
  throw std::runtime_error("ambient_demo: " AMBIENT_PYTHON " cannot be started: " +
                           std::string(std::strerror(errno)));
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
  app.add_option("--log", log,
                 "Further columns of trajectory.csv: wrench, wet, holds, with commas between them")
      ->type_name("WORDS");
  app.add_flag("--quiet", parsed.arguments.quiet, "Print errors only");
  app.footer("Many scenes: --cases FILE.jsonl --out DIR [--shard I/N], by the Python module");
  try {
    const std::string empty = emptyArgument(argc, argv);
    if (!empty.empty()) throw std::invalid_argument(empty);
    app.parse(argc, argv);
    for (const std::string& text : sets) parsed.arguments.overrides.push_back(parseOverride(text));
    parsed.arguments.log = parseFluidLog(log);
    if (parsed.arguments.list + !parsed.arguments.scene.empty() != 1)
      throw CLI::RequiredError("One of SCENE or --list");
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

// Written before the handlers are installed, then only read by the handler: folders, outermost
// first.
std::vector<std::string> to_remove;
std::atomic<bool> is_heard{false}, is_interrupted{false};

/// Handles a signal: removes the folders as far as they are empty, and ends the program. While a
/// run hears signals, the first one only sets is_interrupted. Calls async-signal-safe functions of
/// POSIX.
void handle(int signal) {
  if (is_heard && !is_interrupted.exchange(true)) return;
  for (auto at = to_remove.rbegin(); at != to_remove.rend(); ++at) ::rmdir(at->c_str());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void endOnSignals(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) to_remove.push_back(folder.string());
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, handle);
}

/// The folder of a run. @throws std::runtime_error in one line if files cannot be written to it
struct RunFolder : OutputFolder {
  explicit RunFolder(const fs::path& out) : OutputFolder(out) {
    const OutputFile can_be_written(out / "summary.json");
    endOnSignals(made());
  }
};

/// Signals that come while the folder is made arrive when they know it.
RunFolder openFolder(const fs::path& out) {
  const BlockedSignals until_known;
  return RunFolder(out);
}

RunRecord runShown(const Scene& scene, const std::vector<PreparedBody>& bodies,
                   const Arguments& arguments) {
  ElapsedDisplay display(scene.name + ": simulating", arguments.quiet);
  const auto show = [&display](double share) {
    display.update(share);
    return !is_interrupted;
  };
  return runScene(scene, bodies, show, arguments.log);
}

long long bodiesWithLongSteps(const RunRecord& record) {
  return std::accumulate(
      record.work.begin(), record.work.end(), 0LL,
      [](long long sum, const AmbientCounters& work) { return sum + work.too_long; });
}

/// Writes the files of a run: all of them, or none if one cannot be written.
void writeFiles(const fs::path& out, const Scene& scene, const std::vector<PreparedBody>& bodies,
                const RunRecord& record, const FluidLog& log) {
  OutputFile trajectory(out / "trajectory.csv"), geometry(out / "geometry.json"),
      summary(out / "summary.json");
  trajectory.write(
      makeTrajectoryText(scene, record.motion, fluidLogHeader(log, bodies), record.log));
  geometry.write(makeGeometryText(scene, bodies));
  summary.write(makeSummary(scene, bodies, record));
  trajectory.commit();
  geometry.commit();
  summary.commit();
}

void warn(const std::string& sentence) {
  std::fprintf(stderr, "warning: %s\n", plainLine(sentence).c_str());
}

void runAndWrite(const Arguments& arguments) {
  const Scene scene = readScene(findScene(arguments.scene, sceneFolders()), arguments.overrides);
  const fs::path out =
      arguments.out.empty() ? "out" / fs::path(scene.name) : fs::path(arguments.out);
  RunFolder folder = openFolder(out);
  SceneBodyCache cache(out / "fluid_bodies", scene.threads,
                       arguments.quiet ? nullptr : printReport);
  const std::vector<PreparedBody> bodies = prepareBodies(scene, cache);

  is_heard = true;
  const RunRecord record = runShown(scene, bodies, arguments);
  {
    const BlockedSignals until_all_have_their_names;
    writeFiles(out, scene, bodies, record, arguments.log);
    folder.keep();
    cache.save();
  }
  if (arguments.quiet) return;
  std::istringstream sentences(record.warning);
  for (std::string sentence; std::getline(sentences, sentence);) warn(sentence);
  if (const long long count = bodiesWithLongSteps(record); count > 0)
    warn("steps were too long for the motion of " + std::to_string(count) + " of " +
         std::to_string(record.work.size()) + " bodies");
  std::printf("%s: %lld steps in %.2f s; wrote trajectory.csv and summary.json to %s\n",
              plainLine(scene.name).c_str(), record.steps, record.wall_seconds,
              plainLine(folder.path().string()).c_str());
}

int run(int argc, char** argv) {
  if (std::any_of(argv + 1, argv + argc, isCases)) runCases(argc, argv);
  const Parsed parsed = parseArguments(argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  if (parsed.arguments.list)
    printScenes();
  else
    runAndWrite(parsed.arguments);
  return 0;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  return ambient::runProgram("ambient_demo", [&] { return ambient::run(argc, argv); });
}
