#include <LinearMath/btScalar.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "preprocess/base/output_file.h"
#include "tests/study/stability/atlas_run.h"
#include "tests/support/parse_or_exit.h"

namespace ambient {
namespace {

/// A part of the stability atlas: values that its cases are drawn from.
struct AtlasRow {
  const char* name = "";
  const char* what = "";  ///< one line for the table
  PressureLaw law = PressureLaw::kForm;
  std::vector<double> hertz, density_ratios, speeds, spins;
  bool is_needle = false;                   ///< true: the needle alone; false: the other shapes
  std::vector<double> load_ratios = {0};    ///< AtlasCase::load_ratio
  std::vector<AtlasSetting> settings = {};  ///< empty: all
};

const std::vector<double> kHertz{30, 60, 120, 240, 960};
const std::vector<double> kDensityRatios{1e-3, 1e-2, 0.1, 1, 10, 100, 1e3, 1e4};
const std::vector<double> kSpeeds{0, 0.1, 1, 10, 100, 340};
const std::vector<double> kSpins{0, 1, 10, 100, 1000, 5000};

AtlasRow wideRow(const char* name, const char* what) {
  AtlasRow row;
  row.name = name;
  row.what = what;
  row.hertz = kHertz;
  row.density_ratios = kDensityRatios;
  row.speeds = kSpeeds;
  row.spins = kSpins;
  return row;
}

std::vector<AtlasRow> makeRows() {
  AtlasRow wide = wideRow("wide", "wide ranges of everything");
  AtlasRow published = wideRow("published", "the same by the published law");
  published.law = PressureLaw::kPublished;
  AtlasRow slow = wideRow("slow", "the same in steps of 1/15 s");
  slow.hertz = {15};
  AtlasRow density = wideRow("density", "1e-6, 1e-5, 1e5 and 1e6 times as dense as the fluid");
  density.density_ratios = {1e-6, 1e-5, 1e5, 1e6};
  AtlasRow needle = wideRow("needle", "ellipsoids 1000 times as long as thick");
  needle.is_needle = true;
  AtlasRow stack = wideRow("stack", "two boxes, the upper one of 1000 or 1/1000 of the mass");
  stack.load_ratios = {1e3, 1e-3};
  stack.settings = {AtlasSetting::kOnPlane};
  stack.speeds = {0, 0.1, 1};
  stack.spins = {0, 0.1, 1};
  return {wide, published, slow, density, needle, stack};
}

/// All rows.
const std::vector<AtlasRow>& atlasRows() {
  static const std::vector<AtlasRow> all = makeRows();
  return all;
}

/// Draws the cases of a row at random. Each value of a quantity occurs as often as any other;
/// combinations are random.
class AtlasCaseGenerator {
 public:
  /// @pre row and the shapes of makeAtlasShapes() outlive the generator
  AtlasCaseGenerator(const AtlasRow& row, const std::vector<AtlasShape>& shapes, unsigned seed)
      : row_(row), shapes_(shapes), engine_(seed) {}

  AtlasCase next() {
    AtlasCase c;
    // Number of shapes before the needle, the last one.
    const std::size_t others = shapes_.size() - 1;
    const std::size_t shape = engine_() % others;
    c.shape = &shapes_[row_.is_needle ? others : shape];
    c.setting = static_cast<AtlasSetting>(engine_() % kAtlasSettings);
    if (!row_.settings.empty()) c.setting = any(row_.settings);
    c.law = row_.law;
    c.water = engine_() % 2 == 1;
    c.density_ratio = any(row_.density_ratios);
    c.size = any(std::vector<double>{1e-3, 1e-2, 0.1, 1, 10, 100});
    c.speed = any(row_.speeds);
    c.spin = any(row_.spins);
    c.step = 1 / any(row_.hertz);
    c.seed = static_cast<unsigned>(engine_());
    if (row_.load_ratios.size() > 1) c.load_ratio = any(row_.load_ratios);
    return c;
  }

 private:
  template <class Value>
  const Value& any(const std::vector<Value>& values) {
    return values[engine_() % values.size()];
  }

  const AtlasRow& row_;
  const std::vector<AtlasShape>& shapes_;
  std::mt19937 engine_;
};

/// Tolerance of the relative energy rise: the rounding of Bullet's own numbers. In float the bodies
/// of stock Bullet rise by up to 1.3e-5 in these runs.
constexpr double kMostRise = sizeof(btScalar) == 8 ? 1e-6 : 2e-5;

constexpr double kMuch = 0.01;

const char* nameOf(AtlasSetting setting) {
  constexpr const char* kNames[] = {"free", "falling", "on a plane", "on a joint"};
  return kNames[static_cast<std::size_t>(setting)];
}

// Tolerance of the energy rise by setting. Bullet's contacts and joints may add energy.
double mostRise(AtlasSetting setting) {
  const bool is_anchored = setting == AtlasSetting::kOnPlane || setting == AtlasSetting::kOnJoint;
  return is_anchored ? std::numeric_limits<double>::infinity() : kMostRise;
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

std::string lineOf(const AtlasRow& row, const AtlasCase& c, const AtlasResult& result) {
  char line[256];
  std::snprintf(line, sizeof line, "%s,%s,%s,%s,%g,%g,%g,%g,%g,%u,%g,%d,%lld,%.3e,%.3g\n", row.name,
                c.shape->name.c_str(), nameOf(c.setting), c.water ? "water" : "air",
                c.density_ratio, c.size, c.speed, c.spin, c.step, c.seed, c.load_ratio,
                result.finite ? 1 : 0, result.rejected, result.energy_rise, result.coarse);
  return line;
}

void print(const std::string& name, const Tally& tally) {
  std::printf("%-20s %6lld %11lld %9lld %12lld %12lld %12.1e\n", name.c_str(), tally.runs,
              tally.not_finite, tally.rejected, tally.rose, tally.rose_much, tally.worst_rise);
}

struct Atlas {
  std::string table;  ///< one line per run, as CSV
  bool is_stable = true;
};

void runRow(const AtlasRow& row, const std::vector<AtlasShape>& shapes, int runs, unsigned seed,
            Atlas& atlas) {
  AtlasCaseGenerator cases(row, shapes, seed);
  std::map<AtlasSetting, Tally> tallies, in_vacuum;
  for (int i = 0; i < runs; ++i) {
    const AtlasCase atlas_case = cases.next();
    const AtlasResult result = runAtlasCase(atlas_case);
    tallies[atlas_case.setting].add(result);
    in_vacuum[atlas_case.setting].add(runAtlasCase(atlas_case, AtlasFluid::kNone));
    atlas.table += lineOf(row, atlas_case, result);
  }
  std::printf("%-20s %6s %11s %9s %5s > %.0e %12s %12s\n", row.name, "runs", "not finite",
              "rejected", "rise", kMostRise, "rise > 1 %", "worst rise");
  for (const auto& [setting, tally] : tallies) {
    print(nameOf(setting), tally);
    atlas.is_stable = atlas.is_stable && tally.not_finite == 0 && tally.rejected == 0 &&
                      tally.worst_rise <= mostRise(setting);
  }
  for (const auto& [setting, tally] : in_vacuum)
    print(std::string(nameOf(setting)) + ", stock", tally);
}

struct AtlasArguments {
  std::vector<std::string> rows;
  int runs = 5000;
  unsigned seed = 1;
  std::string out;
};

int run(const AtlasArguments& arguments) {
  const std::vector<AtlasShape> shapes = makeAtlasShapes();
  Atlas atlas;
  atlas.table =
      "row,shape,setting,medium,density_ratio,size,speed,spin,step,seed,load_ratio,finite,rejected,"
      "energy_rise,coarse\n";
  for (const AtlasRow& row : atlasRows()) {
    const std::vector<std::string>& wanted = arguments.rows;
    if (std::find(wanted.begin(), wanted.end(), row.name) != wanted.end())
      runRow(row, shapes, arguments.runs, arguments.seed, atlas);
  }
  if (!arguments.out.empty()) {
    OutputFile file(arguments.out);
    file.write(atlas.table);
    file.commit();
  }
  return atlas.is_stable ? 0 : 1;
}

std::string rowsText() {
  std::string text = "Of these (default: published):";
  for (const AtlasRow& row : atlasRows()) text += "\n" + std::string(row.name) + ": " + row.what;
  return text;
}

std::vector<std::string> rowNames() {
  std::vector<std::string> names;
  for (const AtlasRow& row : atlasRows()) names.push_back(row.name);
  return names;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  ambient::AtlasArguments arguments;
  arguments.rows = {"wide"};
  CLI::App app(
      "Runs of 2 s over density ratio, size, speed, spin, step, shape and surroundings. Exit code "
      "1 if a state was not finite, or the energy rose in free motion.",
      "stability_atlas");
  app.add_option("--rows", arguments.rows, ambient::rowsText())
      ->delimiter(',')
      ->check(CLI::IsMember(ambient::rowNames()))
      ->type_name("ROW,ROW,...");
  app.add_option("--runs", arguments.runs, "How many of each row (default: 5000)")
      ->check(CLI::Range(1, 1000000));
  app.add_option("--seed", arguments.seed, "Of the choice of cases (default: 1)");
  app.add_option("--out", arguments.out, "Write one line per run to this CSV file");
  if (const auto exit_code = ambient::parseOrExit(app, argc, argv)) return *exit_code;
  try {
    return ambient::run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stability_atlas: %s\n", error.what());
    return 1;
  }
}
