#include "tests/preprocess/potential_flow/study/slamming/slamming_table.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/waterline/waterline_builder.h"
#include "tests/preprocess/potential_flow/study/slamming/slamming_cases.h"
#include "tests/preprocess/potential_flow/study/slamming/slamming_fall.h"
#include "tests/reference/water_entry.h"

namespace ambient::study {
namespace {

constexpr double kDepths[] = {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8};  // in radii
constexpr double kShares[] = {0.05, 0.1, 0.2, 0.4, 0.8};             // draught over height
constexpr double kRaise = 1.4;  // draught factor at first contact, docs/theory.md eq. (65)

template <class... Values>
std::string cellOf(const char* format, Values... values) {
  char text[64];
  std::snprintf(text, sizeof text, format, values...);
  return std::string(" ") + text + " |";
}

std::string nameOf(EntrySurface surface) {
  return surface == EntrySurface::kRaised ? "here" : "here, plane not raised";
}

std::string ballLine(const std::string& name, const std::function<double(double)>& coefficient) {
  std::string line = "| " + name + " |";
  for (const double depth : kDepths) line += cellOf("%.2f", coefficient(depth));
  return line;
}

std::string rootLine(const std::string& name, double slope) {
  return ballLine(name, [&](double depth) { return slope * std::sqrt(depth); }) + " |\n";
}

std::string peakOf(const std::function<double(double)>& coefficient) {
  constexpr double kSpacing = 0.005;
  double best = kSpacing;
  for (double depth = kSpacing; depth < 1; depth += kSpacing)
    if (coefficient(depth) > coefficient(best)) best = depth;
  return cellOf("%.2f at %.2f", coefficient(best), best);
}

/// Line of a ball that falls at ten radii a second.
std::string ballFallLine(const std::string& name, const SurfaceCase& ball, double time_step,
                         bool has_loads) {
  const std::vector<FallStep> fall = fallIntoWater({ball.model.shape, 10, time_step, has_loads});
  return ballLine(name, [&](double depth) { return forceAt(fall, depth) / (kPi / 2); }) + " |\n";
}

}  // namespace

std::string ballTable() {
  const SurfaceCase ball = makeBallCase();
  std::string table = "| d/R |";
  for (const double depth : kDepths) table += cellOf("%.2f", depth);
  table += " largest |\n|---|---|---|---|---|---|---|---|---|\n";
  table += rootLine("von Karman, as d → 0", reference::karmanSphereSlope());
  table += rootLine("Wagner, as d → 0", reference::wagnerSphereSlope());
  table += rootLine("measured, as d → 0", reference::measuredSphereSlope());
  for (const EntrySurface surface : {EntrySurface::kUndisturbed, EntrySurface::kRaised}) {
    const auto coefficient = [&](double depth) {
      return slammingForce(ball.model, depth, surface) / (kPi / 2);
    };
    table += ballLine(nameOf(surface), coefficient) + peakOf(coefficient) + "\n";
  }
  return table + ballFallLine("falls, steps of 1/240 s", ball, 1.0 / 240, false) +
         ballFallLine("falls, steps of 1/960 s", ball, 1.0 / 960, false) +
         ballFallLine("the same, with loads on its faces", ball, 1.0 / 960, true);
}

std::string wedgeTable(double length) {
  std::string table =
      "| deadrise | von Karman | Wagner | similarity | wedge's own K | the same, raised |";
  for (const double share : kShares) table += cellOf("here, to %.2f", share);
  for (const double share : kShares) table += cellOf("by its waterline table, to %.2f", share);
  table += "\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const reference::WedgeForce& similar : reference::kSimilarWedges) {
    const double deadrise = similar.degrees * kPi / 180;
    const double own = 2 * reference::wedgeAddedMass(deadrise), rise = std::tan(deadrise);
    const SurfaceCase wedge = makeWedgeCase(deadrise, length);
    const SurfaceCase tabulated = withWaterline(wedge, kDefaultWaterlineSubdivisions);
    table += "|" + cellOf("%.0f°", similar.degrees) +
             cellOf("%.1f", reference::karmanWedgeForce(deadrise)) +
             cellOf("%.1f", reference::wagnerWedgeForce(deadrise)) + cellOf("%.1f", similar.force) +
             cellOf("%.1f", own) + cellOf("%.1f", kRaise * kRaise * own);
    for (const SurfaceCase& body : {wedge, tabulated})
      for (const double share : kShares) {
        const double draught = share * kHalfBreadth * rise;
        const double K = heaveInertia(body.model, draught, EntrySurface::kRaised) / length;
        table += cellOf("%.1f", 2 * K / (draught * draught));
      }
    table += "\n";
  }
  return table;
}

std::string wedgeFallTable(double degrees, double length) {
  const double deadrise = degrees * kPi / 180, height = kHalfBreadth * std::tan(deadrise);
  const SurfaceCase wedge = makeWedgeCase(deadrise, length);
  std::string table = "| wedge of" + cellOf("%.0f°, of its height", degrees);
  for (const double share : kShares) table += cellOf("%.2f", share);
  table += "\n|---|---|---|---|---|---|\n";
  const auto line = [&](const std::string& name, const std::function<double(double)>& force) {
    table += "| " + name + " |";
    for (const double share : kShares) {
      const double draught = share * height;
      table += cellOf("%.1f", force(draught) / (length * draught));
    }
    table += "\n";
  };
  const SurfaceCase tabulated = withWaterline(wedge, kDefaultWaterlineSubdivisions);
  for (const EntrySurface surface : {EntrySurface::kUndisturbed, EntrySurface::kRaised})
    line(nameOf(surface),
         [&](double draught) { return slammingForce(wedge.model, draught, surface); });
  line("by its waterline table", [&](double draught) {
    return slammingForce(tabulated.model, draught, EntrySurface::kRaised);
  });
  const auto fallLine = [&](const std::string& name, double time_step, bool has_loads) {
    const std::vector<FallStep> fall =
        fallIntoWater({wedge.model.shape, 10 * height, time_step, has_loads});
    line(name, [&](double draught) { return forceAt(fall, draught); });
  };
  fallLine("falls, steps of 1/240 s", 1.0 / 240, false);
  fallLine("falls, steps of 1/960 s", 1.0 / 960, false);
  fallLine("the same, with loads on its faces", 1.0 / 960, true);
  return table;
}

}  // namespace ambient::study
