#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "tests/preprocess/potential_flow/study/slamming/slamming_table.h"
#include "tests/support/parse_or_exit.h"

int main(int argc, char** argv) {
  double length = 20;
  CLI::App app{"Forces on bodies that enter the water beside theories, as Markdown.",
               "slamming_study"};
  app.add_option("--length", length, "Length of the wedges, which are 2 m wide [m] (default: 20)")
      ->check(CLI::Range(1.0, 1000.0));
  if (const auto exit_code = ambient::parseOrExit(app, argc, argv)) return *exit_code;
  try {
    std::printf("%s\n", ambient::study::ballTable().c_str());
    std::printf("%s\n", ambient::study::wedgeTable(length).c_str());
    std::printf("%s", ambient::study::wedgeFallTable(20, length).c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "slamming_study: %s\n", error.what());
    return 1;
  }
}
