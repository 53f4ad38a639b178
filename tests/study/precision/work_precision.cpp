#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "demos/integrators/integrators.h"
#include "demos/scene/scene_reader.h"
#include "demos/simulation/body_preparation.h"
#include "preprocess/base/output_file.h"
#include "tests/study/precision/precision_run.h"
#include "tests/support/parse_or_exit.h"

namespace ambient {
namespace {

/// A scene and a duration short enough that chaos does not hide the error.
struct PrecisionCase {
  std::string name;
  std::string scene;
  double duration;  // [s]
  std::vector<SceneOverride> changes;
};

// Wooden cube: 20 cm, 600 kg/m3, slightly tilted.
std::vector<SceneOverride> woodenCube(const std::string& law) {
  return {{"law", law},
          {"bodies.0.shape", "{\"type\": \"box\", \"size\": [0.2, 0.2, 0.2]}"},
          {"bodies.0.mass", "4.8"},
          {"bodies.0.orientation", "[0.98873657, 0.12, 0.08, 0.04]"}};
}

const std::vector<PrecisionCase>& allCases() {
  static const std::vector<PrecisionCase> cases = {
      {"plate_8cm", "plate_8cm", 1, {}},
      {"plate_10cm", "plate_10cm", 1, {}},
      {"golf", "golf_dimpled_spin", 3, {}},
      {"football", "football", 2, {}},
      {"ellipsoid", "underwater_ellipsoid", 2, {}},
      {"balloon", "balloon", 1, {}},
      // Drag stops a plate of 0.2 g from 300 m/s within a few of its lengths.
      {"stiff_feather",
       "plate_8cm",
       1,
       {{"bodies.0.linear_velocity", "[300, 0, 0]"}, {"bodies.0.angular_velocity", "[5, 9, 2]"}}},
      {"flap", "flap_in_current", 1, {}},
      {"chain", "chain_in_water", 1, {}},
      {"pile", "box_pile", 0.5, {}},
      // Plate by the form law, then a wooden cube that rises in water by both laws.
      {"plate_8cm_form", "plate_8cm", 1, {{"law", "\"form\""}}},
      {"card", "tumbling_card", 1, {{"law", "\"published\""}}},
      {"card_form", "tumbling_card", 1, {}},
      {"cube", "sphere_rise", 1, woodenCube("\"published\"")},
      {"cube_form", "sphere_rise", 1, woodenCube("\"form\"")},
  };
  return cases;
}

std::vector<PrecisionMethod> methodsAt(double step) {
  return {{"fast", {1e-3, 1}, step},
          {"leapfrog 1e-2", {1e-2, 0}, step},
          {"leapfrog 1e-3", {1e-3, 0}, step},
          {"leapfrog 1e-4", {1e-4, 256}, step},
          {"pair 1e-3", {1e-3, 0, flyDormandPrince}, step},
          {"pair 1e-5", {1e-5, 0, flyDormandPrince}, step, LoadPrecision::kDouble},
          {"pair 1e-7", {1e-7, 0, flyDormandPrince}, step, LoadPrecision::kDouble},
          {"rk4", {1e-3, 0, flyRungeKutta}, step},
          {"symplectic euler", {1e-3, 0, flySymplecticEuler}, step}};
}

constexpr const char* kHeader =
    "case,method,time_step,position_error,angle_error,microseconds_per_second,"
    "evaluations_per_second,coarse\n";

std::string lineOf(const PrecisionCase& c, const PrecisionMethod& method, const PrecisionRun& run,
                   const PrecisionError& error) {
  char line[256];
  std::snprintf(line, sizeof line, "%s,%s,%.10g,%.4g,%.4g,%.5g,%.5g,%g\n", c.name.c_str(),
                method.name.c_str(), method.time_step, error.position, error.angle,
                1e6 * run.processor_seconds / c.duration, run.load_evaluations / c.duration,
                run.coarse);
  return line;
}

std::string studyCase(const PrecisionCase& c, int takes) {
  Scene scene = readScene(findScene(c.scene, sceneFolders()), c.changes);
  scene.duration = c.duration;
  SceneBodyCache cache;
  const std::vector<PreparedBody> bodies = prepareBodies(scene, cache);
  // Contacts have errors of first order in the world's step, with any integrator of flight.
  const PrecisionMethod exact{
      "reference", {1e-9, 0, flyDormandPrince}, 1.0 / 7680, LoadPrecision::kDouble};
  const PrecisionRun reference = runWithMethod(scene, bodies, exact, 1);
  if (!reference.finite) throw std::runtime_error(c.name + ": the reference is not finite");
  std::string lines;
  for (const int rate : {30, 60, 120, 240, 480, 960}) {
    for (const PrecisionMethod& method : methodsAt(1.0 / rate)) {
      const PrecisionRun run = runWithMethod(scene, bodies, method, takes);
      const std::string line = lineOf(c, method, run, errorOf(run, reference));
      std::fputs(line.c_str(), stdout);
      lines += line;
    }
  }
  return lines;
}

int run(const std::vector<std::string>& names, int takes, const std::string& out) {
  std::string table = kHeader;
  std::fputs(kHeader, stdout);
  for (const PrecisionCase& c : allCases()) {
    const bool is_chosen =
        names.empty() || std::find(names.begin(), names.end(), c.name) != names.end();
    if (is_chosen) table += studyCase(c, takes);
  }
  if (!out.empty()) {
    OutputFile file(out);
    file.write(table);
    file.commit();
  }
  return 0;
}

std::vector<std::string> caseNames() {
  std::vector<std::string> names;
  for (const PrecisionCase& c : allCases()) names.push_back(c.name);
  return names;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  std::vector<std::string> names;
  std::string out;
  int takes = 3;
  CLI::App app("Error of motions against processor time, for every integrator and step, as CSV.",
               "work_precision");
  app.add_option("CASE", names, "Which (default: all)")->check(CLI::IsMember(ambient::caseNames()));
  app.add_option("--takes", takes, "Runs of which the fastest counts (default: 3)")
      ->check(CLI::Range(1, 1000));
  app.add_option("--out", out, "Write the table to this file too");
  if (const auto exit_code = ambient::parseOrExit(app, argc, argv)) return *exit_code;
  try {
    return ambient::run(names, takes, out);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "work_precision: %s\n", error.what());
    return 1;
  }
}
