#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "preprocess/waterline/waterline_builder.h"
#include "tests/preprocess/potential_flow/study/surface_table.h"

using ambient::kDefaultWaterlineSubdivisions;
using ambient::kMostWaterlineSubdivisions;

int main(int argc, char** argv) {
  int poses = 30, panels = 350, subdivisions = kDefaultWaterlineSubdivisions;
  CLI::App app{"Added mass at the surface of the water against the negative image, as Markdown."};
  app.add_option("--poses", poses, "of each shape")->check(CLI::Range(1, 10000));
  app.add_option("--panels", panels, "of the wet part")->check(CLI::Range(20, 10000));
  app.add_option("--subdivisions", subdivisions, "of the waterline tables")
      ->check(CLI::Range(1, kMostWaterlineSubdivisions));
  CLI11_PARSE(app, argc, argv);
  try {
    ambient::study::surfaceTable(poses, panels, subdivisions);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
