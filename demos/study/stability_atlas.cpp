#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/output_file.h"
#include "demos/study/atlas_run.h"

namespace ambient {
namespace {

/// What the energy may rise by, relative: free, nothing but rounding; falling, the error of the
/// splitting into gravity and flow, which is of second order in the step.
constexpr double kMostRise = 1e-6;

constexpr double kMuch = 0.01;

const char* nameOf(AtlasSetting setting) {
  switch (setting) {
    case AtlasSetting::kFree:
      return "free";
    case AtlasSetting::kFalling:
      return "falling";
    case AtlasSetting::kOnPlane:
      return "on a plane";
    case AtlasSetting::kOnJoint:
      break;
  }
  return "on a joint";
}

// Each value of each quantity as often as any other, in all combinations by chance.
class CaseGenerator {
 public:
  CaseGenerator(const std::vector<AtlasShape>& shapes, unsigned seed)
      : shapes_(shapes), engine_(seed) {}

  AtlasCase next() {
    AtlasCase c;
    c.shape = &shapes_[engine_() % shapes_.size()];
    c.setting = static_cast<AtlasSetting>(engine_() % kAtlasSettings);
    c.water = engine_() % 2 == 1;
    c.density_ratio = any({1e-3, 1e-2, 0.1, 1, 10, 100, 1e3, 1e4});
    c.size = any({1e-3, 1e-2, 0.1, 1, 10, 100});
    c.speed = any({0, 0.1, 1, 10, 100, 340});
    c.spin = any({0, 1, 10, 100, 1000, 5000});
    c.step = 1 / any({30, 60, 120, 240, 960});
    c.seed = static_cast<unsigned>(engine_());
    return c;
  }

 private:
  double any(const std::vector<double>& values) { return values[engine_() % values.size()]; }

  const std::vector<AtlasShape>& shapes_;
  std::mt19937 engine_;
};

// Rows may add energy: Bullet pushes bodies apart and pulls joints together.
double mostRise(AtlasSetting setting) {
  const bool has_rows = setting == AtlasSetting::kOnPlane || setting == AtlasSetting::kOnJoint;
  return has_rows ? std::numeric_limits<double>::infinity() : kMostRise;
}

struct Tally {
  long long runs = 0, not_finite = 0, rejected = 0, rose = 0, rose_much = 0;
  double worst_rise = 0;

  void add(const AtlasResult& result) {
    ++runs;
    not_finite += !result.finite;
    rejected += result.rejected > 0;
    rose += !(result.energy_rise <= kMostRise);
    rose_much += !(result.energy_rise <= kMuch);
    worst_rise = std::max(worst_rise, result.energy_rise);
  }
};

std::string lineOf(const AtlasCase& c, const AtlasResult& result) {
  char line[256];
  std::snprintf(line, sizeof line, "%s,%s,%s,%g,%g,%g,%g,%g,%u,%d,%lld,%.3e,%.3g\n",
                c.shape->name.c_str(), nameOf(c.setting), c.water ? "water" : "air",
                c.density_ratio, c.size, c.speed, c.spin, c.step, c.seed, result.finite ? 1 : 0,
                result.rejected, result.energy_rise, result.coarse);
  return line;
}

void print(const std::string& name, const Tally& tally) {
  std::printf("%-20s %6lld %11lld %9lld %12lld %12lld %12.1e\n", name.c_str(), tally.runs,
              tally.not_finite, tally.rejected, tally.rose, tally.rose_much, tally.worst_rise);
}

int run(int runs, unsigned seed, const std::string& out) {
  const std::vector<AtlasShape> shapes = makeAtlasShapes();
  CaseGenerator cases(shapes, seed);
  std::map<AtlasSetting, Tally> tallies, in_vacuum;
  std::string table =
      "shape,setting,medium,density_ratio,size,speed,spin,step,seed,finite,rejected,energy_rise,"
      "coarse\n";
  for (int i = 0; i < runs; ++i) {
    const AtlasCase atlas_case = cases.next();
    const AtlasResult result = runAtlasCase(atlas_case);
    tallies[atlas_case.setting].add(result);
    in_vacuum[atlas_case.setting].add(runAtlasCase(atlas_case, AtlasFluid::kNone));
    table += lineOf(atlas_case, result);
  }
  if (!out.empty()) {
    OutputFile file(out);
    file.write(table);
    file.commit();
  }
  std::printf("%-20s %6s %11s %9s %12s %12s %12s\n", "setting", "runs", "not finite", "rejected",
              "rise > 1e-6", "rise > 1 %", "worst rise");
  bool is_stable = true;
  for (const auto& [setting, tally] : tallies) {
    print(nameOf(setting), tally);
    is_stable = is_stable && tally.not_finite == 0 && tally.rejected == 0 &&
                tally.worst_rise <= mostRise(setting);
  }
  for (const auto& [setting, tally] : in_vacuum)
    print(std::string(nameOf(setting)) + ", stock", tally);
  return is_stable ? 0 : 1;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  int runs = 5000;
  unsigned seed = 1;
  std::string out;
  CLI::App app(
      "Runs of 2 s over density ratio, size, speed, spin, step, shape and surroundings. Exit code "
      "1 "
      "if a state was not finite, or the energy rose in free motion.",
      "stability_atlas");
  app.add_option("--runs", runs, "How many (default: 5000)")->check(CLI::Range(1, 1000000));
  app.add_option("--seed", seed, "Of the choice of cases (default: 1)");
  app.add_option("--out", out, "Write one line per run to this CSV file");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return ambient::run(runs, seed, out);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stability_atlas: %s\n", error.what());
    return 1;
  }
}
