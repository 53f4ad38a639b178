#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "preprocess/waterline/waterline_builder.h"
#include "tests/preprocess/potential_flow/study/image_flow/surface_table.h"
#include "tests/support/parse_or_exit.h"

using ambient::kDefaultWaterlineSubdivisions;
using ambient::kMostWaterlineSubdivisions;

int main(int argc, char** argv) {
  int poses = 30, panels = 350, subdivisions = kDefaultWaterlineSubdivisions;
  CLI::App app{"Added mass at the surface of the water against the negative image, as Markdown.",
               "image_flow_study"};
  app.add_option("--poses", poses, "Poses of each shape (default: 30)")
      ->check(CLI::Range(1, 10000));
  app.add_option("--panels", panels, "Panels of the wet part (default: 350)")
      ->check(CLI::Range(20, 10000));
  app.add_option("--subdivisions", subdivisions, "Divisions of the waterline tables (default: 4)")
      ->check(CLI::Range(1, kMostWaterlineSubdivisions));
  if (const auto exit_code = ambient::parseOrExit(app, argc, argv)) return *exit_code;
  try {
    ambient::study::surfaceTable(poses, panels, subdivisions);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "image_flow_study: %s\n", error.what());
    return 1;
  }
}
