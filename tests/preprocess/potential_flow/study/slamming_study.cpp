#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "tests/preprocess/potential_flow/study/slamming_table.h"

int main(int argc, char** argv) {
  double length = 20;
  CLI::App app{"Forces on bodies that enter the water beside theories, as Markdown."};
  app.add_option("--length", length, "of the wedges [m], which are 2 m wide")
      ->check(CLI::Range(1.0, 1000.0));
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%s\n", ambient::study::ballTable().c_str());
    std::printf("%s\n", ambient::study::wedgeTable(length).c_str());
    std::printf("%s", ambient::study::wedgeFallTable(20, length).c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
