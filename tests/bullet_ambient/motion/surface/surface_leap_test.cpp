#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/floating_runs.h"

// Light bodies that leave the water or fall into it, at steps of games, beside the limit of short
// steps.

namespace ambient {
namespace {

using test::FloatingDef;
using test::FloatingRun;

constexpr double kShort = 1 / 4000.0;  // [s]
constexpr double kSteps[] = {1 / 30.0, 1 / 60.0, 1 / 75.0, 1 / 144.0, 1 / 240.0};

struct Leap {
  double apex = 0;      ///< height of the centre of mass [m]
  int substeps = 0;     ///< from the start on
  int largest = 0;      ///< number of substeps of one step
  bool gained = false;  ///< the energy has grown in a step
};

/// Lets a body go at a depth and follows it to its highest point. A parabola through the last three
/// heights has the apex.
Leap leapFrom(const FloatingDef& def, double depth, double step, const FlightSettings& settings) {
  FloatingRun body(def);
  body.settings = settings;
  body.state.position = {0, 0, -depth};
  Leap leap;
  double before = -depth, now = -depth, energy = body.energy();
  for (double time = 0; time < 3; time += step) {
    body.step(step);
    leap.substeps += body.count.substeps;
    leap.largest = std::max(leap.largest, body.count.substeps);
    const double left = body.energy(), scale = body.mass() * def.gravity * depth;
    leap.gained = leap.gained || left > energy + 1e-9 * scale;
    energy = left;
    const double next = body.state.position.z(), bend = before - 2 * now + next;
    if (next < now && now > 0) {
      leap.apex = now - (next - before) * (next - before) / (8 * bend);
      return leap;
    }
    before = now;
    now = next;
  }
  ADD_FAILURE() << "does not leap";
  return leap;
}

struct Leaper {
  const char* name;
  FluidBody shape;
};

std::vector<Leaper> leapers() {
  return {{"ball", test::floatingBall(0.5)},
          {"box", test::floatingBox({0.8, 0.8, 0.8})},
          {"ellipsoid", test::floatingEllipsoid({0.3, 0.3, 0.5}, 2)}};
}

FloatingDef leaperDef(const Leaper& leaper, double specific_gravity, bool has_loads) {
  FloatingDef def;
  def.shape = leaper.shape;
  def.specific_gravity = specific_gravity;
  def.gyration = Vector3::Constant(0.3);
  def.has_loads = has_loads;
  return def;
}

TEST(SurfaceLeap, IsAsHighAtLongStepsAsAtShortOnes) {
  for (const Leaper& leaper : leapers()) {
    for (const double specific_gravity : {0.1146, 0.4}) {
      for (const bool has_loads : {false, true}) {
        const FloatingDef def = leaperDef(leaper, specific_gravity, has_loads);
        const double limit = leapFrom(def, 1.5, kShort, {}).apex;
        for (const double step : kSteps) {
          const Leap leap = leapFrom(def, 1.5, step, {});
          EXPECT_NEAR(leap.apex, limit, 0.03 * limit)
              << leaper.name << ", " << specific_gravity << ", loads " << has_loads << ", " << step;
          EXPECT_FALSE(leap.gained) << leaper.name << ", " << step;
        }
      }
    }
  }
}

// In a fluid without loads nothing but the change of the added mass asks for substeps.
TEST(SurfaceLeap, ToleranceSeesTheWayOut) {
  const FloatingDef def = leaperDef(leapers()[0], 0.1146, false);
  FlightSettings fine;
  fine.tolerance = 1e-5;
  fine.max_substeps = 256;
  const double limit = leapFrom(def, 1.5, kShort, {}).apex;
  const Leap usual = leapFrom(def, 1.5, 1 / 60.0, {}), exact = leapFrom(def, 1.5, 1 / 60.0, fine);
  EXPECT_GT(usual.largest, 1);
  EXPECT_GT(exact.substeps, 3 * usual.substeps);
  EXPECT_NEAR(exact.apex, limit, 0.001 * limit);
}

}  // namespace
}  // namespace ambient
