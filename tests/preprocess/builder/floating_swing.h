#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "preprocess/builder/shape_builder.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/support/floating_runs.h"

namespace ambient::test {

/// First extremes of a free decay over the initial value, and the period [s].
struct Swing {
  double extremes[4];
  double period;
};

/// Swing of a value over its initial value, in steps of 1/240 s.
template <class Value>
Swing swingOf(FloatingRun& run, double time, const Value& value) {
  constexpr double kStep = 1 / 240.0;
  const double start = value();
  std::vector<double> signal;
  for (int i = 0; i * kStep < time; ++i) {
    signal.push_back(value() / start);
    run.step(kStep);
  }
  const auto extremes = extremesOf(signal, kStep);
  EXPECT_GE(extremes.size(), 4u);
  Swing swing{};
  for (std::size_t i = 0; i < 4 && i < extremes.size(); ++i) swing.extremes[i] = extremes[i].value;
  if (extremes.size() >= 4) swing.period = extremes[2].time - extremes[0].time;
  return swing;
}

inline void expectSwing(const Swing& swing, const Swing& theory, double period_error) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(swing.extremes[i], theory.extremes[i], 0.06) << i;
  EXPECT_NEAR(swing.period, theory.period, period_error * theory.period)
      << swing.period / theory.period;
}

/// Gyration of 0.4 of the widths B_i = sqrt(12 I_i / A_w), centre of mass in the waterline.
inline FloatingDef floatingDef(const FluidBody& body, double length, double breadth) {
  FloatingDef def;
  def.shape = body;
  def.gyration = 0.4 * Vector3(breadth, length, length);
  return def;
}

/// Body of a shape in JSON, with 1200 panels at most.
inline FluidBody bodyOfShape(const std::string& shape, ShapeBuildSettings settings = {}) {
  settings.flow.max_panels = 1200;
  return buildShape(readShape(nlohmann::json::parse(shape), "", "shape.json"), settings).body;
}

/// Added mass of a half-submerged body, z axis up.
inline Matrix6 halfSubmerged(const FluidBody& body) {
  FloatingDef def;
  def.shape = body;
  const FloatingRun run(def);
  return run.model().wetted->inertia(run.immersion());
}

}  // namespace ambient::test
