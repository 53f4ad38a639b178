#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "demos/simulation/output/run_files.h"
#include "preprocess/base/output_file.h"
#include "preprocess/shape/json_schema.h"
#include "tests/study/reality/falling_run.h"
#include "tests/study/reality/measured_coefficient.h"
#include "tests/study/reality/measured_shapes.h"
#include "tests/support/parse_or_exit.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

constexpr PressureLaw kLaws[] = {PressureLaw::kPublished, PressureLaw::kForm};

/// Shapes made so far, by type and size.
using MadeShapes = std::map<std::pair<std::string, double>, FluidBody>;

std::string coefficientLine(const nlohmann::json& row, MadeShapes& made) {
  const nlohmann::json& shape = row.at("shape");
  const std::pair key(shape.at("type").get<std::string>(), shape.value("size", 1.0));
  if (made.count(key) == 0) made[key] = makeMeasuredShape(key.first, key.second);
  const FluidBody& body = made[key];
  const MeasuredFlow flow = readMeasuredFlow(row.at("flow"));
  std::string line = row.at("id").get<std::string>();
  for (const PressureLaw law : kLaws) {
    char number[32];
    std::snprintf(number, sizeof number, ",%.5g", computeCoefficient(body, flow, law));
    line += number;
  }
  return line + "\n";
}

std::string coefficients(const fs::path& measurements) {
  const std::string source = measurements.string();
  const nlohmann::json file = parseJson(readBytes(measurements), source);
  std::string table = "id,published,form\n";
  MadeShapes made;
  for (const nlohmann::json& row : file.at("rows")) {
    if (!row.contains("flow")) continue;
    try {
      table += coefficientLine(row, made);
    } catch (const std::exception& error) {
      throw std::runtime_error(source + ": " + row.at("id").dump() + ": " + error.what());
    }
  }
  return table;
}

/// Table of C_N against the incidence of a plate.
std::string plateCurve() {
  const FluidBody plate = makeMeasuredShape("plate", 1);
  std::string table = "incidence,published,form\n";
  for (int degrees = 1; degrees <= 90; ++degrees) {
    const MeasuredFlow flow = readMeasuredFlow({{"of", "normal"}, {"incidence", degrees}});
    char line[64];
    std::snprintf(line, sizeof line, "%d,%.5g,%.5g\n", degrees,
                  computeCoefficient(plate, flow, kLaws[0]),
                  computeCoefficient(plate, flow, kLaws[1]));
    table += line;
  }
  return table;
}

/// Appends the falls of one body by both laws to `table`, their paths to `paths`.
void addFalls(const FallingCase& c, std::string& table, std::string& paths) {
  for (const PressureLaw law : kLaws) {
    const FallingRun run = runFall(c, law);
    const std::string line = fallLine(c, law, run);
    std::fputs(line.c_str(), stdout);
    std::fflush(stdout);
    table += line;
    if (c.keeps_path) paths += pathLines(c, law, run);
  }
}

void writeFalls(const fs::path& falls, const fs::path& folder) {
  std::string table = fallHeader(), paths = pathHeader();
  for (const FallingCase& c : readFallingCases(falls)) addFalls(c, table, paths);
  writeFile(folder / "falls.csv", table);
  writeFile(folder / "paths.csv", paths);
}

int run(const fs::path& measurements, const fs::path& folder) {
  OutputFolder out(folder);
  writeFile(folder / "coefficients.csv", coefficients(measurements));
  writeFile(folder / "plate.csv", plateCurve());
  out.keep();
  writeFalls(measurements.parent_path() / "falls.json", folder);
  return 0;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  std::string measurements, out;
  CLI::App app("Measured coefficients and falls of bodies by both pressure laws, as CSV.",
               "reality");
  app.add_option("MEASUREMENTS", measurements,
                 "data/reality/measurements.json; falls are those of falls.json beside it")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--out", out, "Folder of coefficients.csv, plate.csv, falls.csv and paths.csv")
      ->required();
  if (const auto exit_code = ambient::parseOrExit(app, argc, argv)) return *exit_code;
  try {
    return ambient::run(measurements, out);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "reality: %s\n", error.what());
    return 1;
  }
}
