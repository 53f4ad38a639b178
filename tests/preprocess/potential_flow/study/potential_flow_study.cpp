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
#include "tests/preprocess/potential_flow/study/point_source_race.h"

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
  CLI::App app{"Accuracy, order of convergence and speed of the added mass, as Markdown tables."};
  app.add_option("--table", tables, "accuracy, convergence, race; all by default")
      ->check(CLI::IsMember(std::set<std::string>{"accuracy", "convergence", "race"}));
  app.add_option("--shape", shape, "only shapes whose name holds this, in the table of accuracy");
  app.add_option("--point-sources", script, "the script to race against");
  app.add_option("--out", out, "file for the tables");
  app.add_option("--curve", curve, "instead of tables: file for error over run time, as CSV");
  CLI11_PARSE(app, argc, argv);
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
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
