#include "tests/preprocess/potential_flow/study/accuracy_table.h"

#include <algorithm>
#include <cstdio>

#include "tests/preprocess/potential_flow/study/accuracy_cases.h"

namespace ambient::study {
namespace {

std::string percentText(double error) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", 100 * error);
  return text;
}

std::string referenceText(const Reference& reference) {
  if (reference.correction == 0) return "known";
  return percentText(reference.correction);
}

bool isCoupled(const Reference& reference) {
  return !reference.added_mass.topRightCorner<3, 3>().isZero(1e-3);
}

std::string lineOf(const AccuracyCase& one, const AccuracyRow& row, const Reference& reference) {
  const double error = std::max({row.rotation, row.translation, row.coupling});
  const double wanted = wantedError(one.target);
  char line[512];
  std::snprintf(
      line, sizeof line, "| %s | %ld | %ld | %s | %s | %s | %.1e | %s | %g %%%s | %.1f s |\n",
      one.shape.c_str(), static_cast<long>(one.mesh.triangleCount()), static_cast<long>(row.panels),
      percentText(row.rotation).c_str(), percentText(row.translation).c_str(),
      isCoupled(reference) ? percentText(row.coupling).c_str() : "", row.should_be_zero,
      referenceText(reference).c_str(), 100 * wanted,
      error > wanted || row.should_be_zero > 1e-4 ? " **missed**" : "", row.processor_seconds);
  return line;
}

}  // namespace

std::string accuracyTable(const std::string& filter) {
  std::string table =
      "| shape | faces | panels | rotation | translation | coupling | zeros | reference | wanted | "
      "processor |\n|---|---|---|---|---|---|---|---|---|---|\n";
  std::fputs(table.c_str(), stdout);
  for (const AccuracyCase& one : accuracyCases()) {
    if (one.shape.find(filter) == std::string::npos) continue;
    const Reference reference = one.reference();
    const std::string line = lineOf(one, measureAccuracy(one, reference), reference);
    std::fputs(line.c_str(), stdout);
    std::fflush(stdout);
    table += line;
  }
  return table;
}

}  // namespace ambient::study
