// Solves, fits and checks the tables of the added mass of simple shapes.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "tests/preprocess/table_generator/table_check.h"
#include "tests/preprocess/table_generator/table_fit.h"
#include "tests/preprocess/table_generator/table_samples.h"

namespace ambient {
namespace {

constexpr const char* kUsage =
    "added_mass_tables make SAMPLES SOURCE [SECONDS]   solve what SAMPLES lacks, for so long; "
    "when\n"
    "                                                  all is there, fit it and write SOURCE\n"
    "added_mass_tables check KIND [SHAPES [SEED]]      errors over so many (20) random shapes:\n"
    "                                                  box, cylinder, capsule or cone\n";

/// Returns the number of shapes left unsolved when the time is over.
int solveMissing(TableSamples& samples, double seconds) {
  const auto start = std::chrono::steady_clock::now();
  int left = 0;
  for (const TableShape& shape : tableShapes()) {
    if (samples.find(shape)) continue;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (elapsed.count() < seconds) {
      samples.add(shape, solveShape(shape));
    } else {
      ++left;
    }
  }
  return left;
}

int make(const std::string& samples_file, const std::string& source_file, double seconds) {
  TableSamples samples(samples_file);
  if (const int left = solveMissing(samples, seconds)) {
    std::printf("%d shapes are left: run it again\n", left);
    return 0;
  }
  for (const auto kind : kTableKinds) {
    for (const FittedSeries& series : fitTable(kind, samples))
      std::printf("%s: %d x %d, largest residual %.1e\n", series.name.c_str(), series.rows,
                  series.columns, series.largest_residual);
  }
  std::ofstream stream(source_file);
  stream << tableSource(samples);
  return stream.flush() ? 0 : 1;
}

int run(const std::vector<std::string>& words) {
  const auto number = [&](std::size_t i, double otherwise) {
    return words.size() > i ? std::atof(words[i].c_str()) : otherwise;
  };
  if (words.size() >= 3 && words[0] == "make") return make(words[1], words[2], number(3, 1e9));
  for (const auto kind : kTableKinds) {
    if (words.size() < 2 || words[0] != "check" || words[1] != nameOf(kind)) continue;
    const int shapes = static_cast<int>(number(2, 20)), seed = static_cast<int>(number(3, 1));
    std::fputs(checkTable(kind, shapes, seed).c_str(), stdout);
    return 0;
  }
  std::fputs(kUsage, stderr);
  return 2;
}

}  // namespace
}  // namespace ambient

int main(int count, char** words) {
  try {
    return ambient::run({words + 1, words + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
