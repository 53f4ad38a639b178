#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/study/accuracy_table.h"
#include "tests/study/convergence_table.h"
#include "tests/study/point_source_race.h"

int main(int argc, char** argv) {
  std::vector<std::string> tables{"accuracy", "convergence", "race"};
  std::string shape, out, script = AMBIENT_POINT_SOURCES;
  CLI::App app{"Accuracy, order of convergence and speed of the added mass, as Markdown tables."};
  app.add_option("--table", tables, "accuracy, convergence, race; all by default")
      ->check(CLI::IsMember(std::set<std::string>{"accuracy", "convergence", "race"}));
  app.add_option("--shape", shape, "only shapes whose name holds this, in the table of accuracy");
  app.add_option("--point-sources", script, "the script to race against");
  app.add_option("--out", out, "file for the tables");
  CLI11_PARSE(app, argc, argv);
  try {
    std::string text;
    for (const std::string& table : tables) {
      if (table == "accuracy") text += ambient::study::accuracyTable(shape) + "\n";
      if (table == "convergence") text += ambient::study::convergenceTable() + "\n";
      if (table == "race") text += ambient::study::pointSourceRace(script) + "\n";
    }
    if (out.empty()) return 0;
    std::ofstream file(out);
    file << text;
    if (!file.flush()) throw std::runtime_error(out + ": cannot be written");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
