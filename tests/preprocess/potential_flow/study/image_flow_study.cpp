#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "tests/preprocess/potential_flow/study/surface_table.h"

int main(int argc, char** argv) {
  int poses = 30, panels = 350;
  CLI::App app{"Added mass at the surface of the water against the negative image, as Markdown."};
  app.add_option("--poses", poses, "of each shape")->check(CLI::Range(1, 10000));
  app.add_option("--panels", panels, "of the wet part")->check(CLI::Range(20, 10000));
  CLI11_PARSE(app, argc, argv);
  try {
    ambient::study::surfaceTable(poses, panels);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
