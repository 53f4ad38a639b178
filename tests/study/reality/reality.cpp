#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "demos/simulation/output/run_files.h"
#include "preprocess/base/output_file.h"
#include "preprocess/shape/json_schema.h"
#include "tests/study/reality/falling_cases.h"
#include "tests/study/reality/measured_shapes.h"
#include "tests/support/parse_or_exit.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

constexpr PressureLaw kLaws[] = {PressureLaw::kPublished, PressureLaw::kForm};

std::string numbers(const std::function<double(PressureLaw)>& value) {
  std::string cells;
  for (const PressureLaw law : kLaws) {
    char number[32];
    std::snprintf(number, sizeof number, ",%.5g", value(law));
    cells += number;
  }
  return cells;
}

/// Coefficients of a row by both laws.
std::string coefficientCells(const nlohmann::json& row) {
  const FluidBody& body = measuredShape(row.at("shape"));
  const MeasuredFlow flow = readMeasuredFlow(row.at("flow"));
  return numbers([&](PressureLaw law) { return computeCoefficient(body, flow, law); });
}

/// Terminal speeds by both laws over the measured one.
std::string settlingCells(const nlohmann::json& row) {
  const FluidBody& body = measuredShape(row.at("shape"));
  const MeasuredFlow flow = readMeasuredFlow(row.at("flow"));
  return numbers([&](PressureLaw law) {
    return computeSettling(body, flow, row.at("value").get<double>(), law);
  });
}

/// Calls `use` with each entry of a file of measurements.
void forEach(const fs::path& file, const char* entries,
             const std::function<void(const nlohmann::json&)>& use) {
  const std::string source = file.string();
  const nlohmann::json read = parseJson(readBytes(file), source);
  for (const nlohmann::json& entry : read.at(entries)) {
    try {
      use(entry);
    } catch (const std::exception& error) {
      throw std::runtime_error(source + ": " + entry.at("id").dump() + ": " + error.what());
    }
  }
}

std::string coefficients(const fs::path& measurements) {
  std::string table = "id,published,form\n";
  forEach(measurements, "rows", [&](const nlohmann::json& row) {
    if (row.contains("flow"))
      table += row.at("id").get<std::string>() + coefficientCells(row) + "\n";
  });
  return table;
}

/// Row of measurements.json for a point of a set.
nlohmann::json rowOf(const nlohmann::json& set, const nlohmann::json& point) {
  nlohmann::json row{{"shape", set.at("shape")}, {"flow", set.at("flow")}};
  for (std::size_t i = 0; i < point.size(); ++i) {
    const std::string column = set.at("columns").at(i);
    const bool is_flow = column == "reynolds" || column == "spin" || column == "roughness";
    (column == "value" ? row[column] : row[is_flow ? "flow" : "shape"][column]) = point[i];
  }
  return row;
}

/// Measured curves over the Reynolds number; speeds where the set is one of settling bodies.
std::string curves(const fs::path& file) {
  std::string table = "id,reynolds,value,published,form,speed published,speed form\n";
  forEach(file, "sets", [&](const nlohmann::json& set) {
    for (const nlohmann::json& point : set.at("points")) {
      const nlohmann::json row = rowOf(set, point);
      char measured[64];
      std::snprintf(measured, sizeof measured, ",%.5g,%.5g",
                    row.at("flow").at("reynolds").get<double>(), row.at("value").get<double>());
      table += set.at("id").get<std::string>() + measured + coefficientCells(row) +
               (set.value("settles", false) ? settlingCells(row) : ",,") + "\n";
    }
  });
  return table;
}

/// Table of C_N against the incidence of a plate.
std::string plateCurve() {
  const FluidBody& plate = measuredShape({{"type", "plate"}, {"size", 1}});
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
  writeFile(folder / "curves.csv", curves(measurements.parent_path() / "curves.json"));
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
                 "data/reality/measurements.json; falls.json and curves.json are beside it")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--out", out,
                 "Folder of coefficients.csv, curves.csv, plate.csv, falls.csv and paths.csv")
      ->required();
  if (const auto exit_code = ambient::parseOrExit(app, argc, argv)) return *exit_code;
  try {
    return ambient::run(measurements, out);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "reality: %s\n", error.what());
    return 1;
  }
}
