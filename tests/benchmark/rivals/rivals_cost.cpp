// What the fluid of this library and of others costs, and how right it is: engines side by side in
// one run, on one core. docs/rivals.md has the results.
//
//   rivals_cost --out RESULTS.json

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "preprocess/base/output_file.h"
#include "tests/benchmark/rivals/cases.h"
#include "tests/support/parse_or_exit.h"

namespace ambient::rivals {
namespace {

using nlohmann::ordered_json;

struct Options {
  std::filesystem::path out;
  bool is_quick = false;
};

/// Sizes of the runs.
struct Effort {
  int bodies, edge, rounds, steps;
};

Effort effortOf(const Options& options) {
  return options.is_quick ? Effort{20, 3, 1, 10} : Effort{1000, 8, 8, 60};
}

std::vector<Engine> builtEngines() {
  std::vector<Engine> engines{ambientEngine(), handEngine()};
#if AMBIENT_RIVALS_JOLT
  engines.push_back(joltEngine());
#endif
#if AMBIENT_RIVALS_MUJOCO
  engines.push_back(mujocoEngine());
#endif
  return engines;
}

std::vector<std::string> missingEngines() {
  std::vector<std::string> missing;
  if (!AMBIENT_RIVALS_JOLT) missing.push_back("Jolt: left out, configure with -DJolt_ROOT=PREFIX");
  if (!AMBIENT_RIVALS_MUJOCO)
    missing.push_back("MuJoCo: left out, configure with -Dmujoco_ROOT=PREFIX");
  return missing;
}

/// Processor time of this process [s].
double processorTime() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double secondsForStep(World& world) {
  const double begin = processorTime();
  world.step();
  return processorTime() - begin;
}

/// Least time of a step [s].
struct Cost {
  double dry = 1e300, wet = 1e300;
};

/// The same bodies without fluid. Apart from each other they are weightless, as most are in water,
/// so that both worlds move alike.
Scene dryOf(const Scene& scene) {
  Scene dry = scene;
  if (!scene.room) dry.gravity = 0;
  return dry;
}

/// One round: both worlds in turns. Every other round makes the dry world first: which one is first
/// in memory can change its step by a fifth. False if the engine has no such fluid.
bool addRound(const Engine& engine, const CostCase& c, int steps, bool is_dry_first, Cost& cost) {
  std::unique_ptr<World> dry, wet;
  if (is_dry_first) dry = engine.make(dryOf(c.scene), false);
  wet = engine.make(c.scene, true);
  if (!wet) return false;
  if (!dry) dry = engine.make(dryOf(c.scene), false);
  for (int i = 0; i < c.settling + steps; ++i) {
    const double dry_time = secondsForStep(*dry), wet_time = secondsForStep(*wet);
    if (i < c.settling) continue;
    cost.dry = std::min(cost.dry, dry_time);
    cost.wet = std::min(cost.wet, wet_time);
  }
  return true;
}

/// Microseconds per body and step.
ordered_json costOf(const Cost& cost, std::size_t bodies) {
  const double scale = 1e6 / static_cast<double>(bodies);
  return {{"dry", cost.dry * scale},
          {"fluid", (cost.wet - cost.dry) * scale},
          {"ratio", cost.wet / cost.dry}};
}

/// Engines in turns, so that a slow minute of the machine is one round of each.
ordered_json costsOf(const std::vector<Engine>& engines, const CostCase& c, const Effort& effort) {
  std::vector<Cost> costs(engines.size());
  std::vector<bool> has_fluid(engines.size(), true);
  for (int round = 0; round < effort.rounds; ++round)
    for (std::size_t k = 0; k < engines.size(); ++k)
      has_fluid[k] =
          has_fluid[k] && addRound(engines[k], c, effort.steps, round % 2 == 1, costs[k]);
  ordered_json found;
  for (std::size_t k = 0; k < engines.size(); ++k)
    found[engines[k].name] =
        has_fluid[k] ? costOf(costs[k], c.scene.starts.size()) : ordered_json();
  return found;
}

/// The number, or null if the engine has none.
ordered_json numberOf(const Engine& engine, const AccuracyCase& c) {
  const auto world = engine.make(c.scene, true);
  const double number = world ? c.measure(*world, c.scene) : std::nan("");
  return std::isfinite(number) ? ordered_json(number) : ordered_json();
}

void print(const std::string& name, const ordered_json& row) {
  std::printf("%-26s", name.c_str());
  for (const auto& [engine, value] : row.items()) {
    std::printf("  %s ", engine.c_str());
    if (value.is_null()) std::printf("none");
    if (value.is_number()) std::printf("%.4g", value.get<double>());
    if (value.is_object())
      std::printf("%.3f us, %.2fx", value["fluid"].get<double>(), value["ratio"].get<double>());
  }
  std::printf("\n");
  std::fflush(stdout);
}

ordered_json costTable(const std::vector<Engine>& engines, const Effort& effort) {
  ordered_json table = ordered_json::array();
  for (const CostCase& c : costCases(effort.bodies, effort.edge)) {
    const ordered_json costs = costsOf(engines, c, effort);
    print(c.name, costs);
    table.push_back({{"case", c.name}, {"bodies", c.scene.starts.size()}, {"engines", costs}});
  }
  return table;
}

/// Each number with the cost of a crowd of the same bodies.
ordered_json accuracyTable(const std::vector<Engine>& engines, const Effort& effort) {
  ordered_json table = ordered_json::array();
  for (const AccuracyCase& c : accuracyCases()) {
    ordered_json numbers;
    for (const Engine& engine : engines) numbers[engine.name] = numberOf(engine, c);
    print(c.name + " [" + c.unit + "]", numbers);
    const ordered_json costs = costsOf(engines, {c.name, crowdOf(c.scene, effort.bodies)}, effort);
    print("  1000 of them", costs);
    table.push_back({{"case", c.name},
                     {"unit", c.unit},
                     {"reference", c.reference},
                     {"source", c.source},
                     {"numbers", numbers},
                     {"costs", costs}});
  }
  return table;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  char date[16];
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  return date;
}

ordered_json describe(const std::vector<Engine>& engines) {
  ordered_json list = ordered_json::array();
  for (const Engine& engine : engines)
    list.push_back(
        {{"name", engine.name}, {"version", engine.version}, {"settings", engine.settings}});
  return list;
}

int run(const Options& options) {
  const Effort effort = effortOf(options);
  const std::vector<Engine> engines = builtEngines();
  OutputFile out(options.out);
  for (const std::string& missing : missingEngines())
    std::fprintf(stderr, "rivals_cost: %s\n", missing.c_str());
  ordered_json results{
      {"date", today()},           {"processor", processor()},     {"compiler", AMBIENT_COMPILER},
      {"quick", options.is_quick}, {"engines", describe(engines)}, {"missing", missingEngines()}};
  results["cost"] = costTable(engines, effort);
  results["accuracy"] = accuracyTable(engines, effort);
  out.write(results.dump(1) + "\n");
  out.commit();
  return 0;
}

}  // namespace
}  // namespace ambient::rivals

int main(int argc, char** argv) {
  ambient::rivals::Options options;
  CLI::App app("Fluids of engines side by side: what they cost and how right they are",
               "rivals_cost");
  app.add_option("--out", options.out, "file for the results, JSON")->required();
  app.add_flag("--quick", options.is_quick,
               "few bodies and steps, to see that all runs: times mean nothing");
  if (const auto code = ambient::parseOrExit(app, argc, argv)) return *code;
  return ambient::runProgram("rivals_cost", [&] { return ambient::rivals::run(options); });
}
