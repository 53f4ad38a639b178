#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/preprocess/potential_flow/study/accuracy_table.h"
#include "tests/preprocess/potential_flow/study/convergence_table.h"
#include "tests/preprocess/potential_flow/study/cost_curve.h"
#include "tests/preprocess/potential_flow/study/point_sources/point_source_race.h"
#include "tests/support/parse_or_exit.h"

namespace {

void write(const std::string& name, const std::string& text) {
  std::ofstream file(name);
  file << text;
  if (!file.flush()) throw std::runtime_error(name + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> tables{"accuracy", "convergence", "race"};
  std::string shape, out, curve, script = AMBIENT_POINT_SOURCES;
  CLI::App app{"Accuracy, order of convergence and speed of the added mass, as Markdown tables.",
               "potential_flow_study"};
  app.add_option("--table", tables, "Which tables to make (default: all)")
      ->check(CLI::IsMember(std::set<std::string>{"accuracy", "convergence", "race"}));
  app.add_option("--shape", shape, "Only shapes whose name holds this, in the table of accuracy");
  app.add_option("--point-sources", script, "The script to race against");
  app.add_option("--out", out, "Write the tables to this file");
  app.add_option("--curve", curve,
                 "Write the error over the run time to this CSV file, and no tables");
  if (const auto exit_code = ambient::parseOrExit(app, argc, argv)) return *exit_code;
  try {
    if (!curve.empty()) {
      write(curve, ambient::study::costCurve(script));
      return 0;
    }
    std::string text;
    for (const std::string& table : tables) {
      if (table == "accuracy") text += ambient::study::accuracyTable(shape) + "\n";
      if (table == "convergence") text += ambient::study::convergenceTable() + "\n";
      if (table == "race") text += ambient::study::pointSourceRace(script) + "\n";
    }
    if (!out.empty()) write(out, text);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "potential_flow_study: %s\n", error.what());
    return 1;
  }
}
