#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/spatial/rotation.h"
#include "tests/support/bodies/vessel_bodies.h"
#include "tests/support/floating_runs.h"

// A barge of 2 x 1 x 0.5 m with walls of 2 cm and 200 kg in water of 1000 kg/m^3: its hold has
// 1.96 x 0.96 x 0.48 m.
namespace ambient::test::barge {

constexpr double kBargeLength = 2, kBargeWidth = 1, kBargeHeight = 0.5, kBargeWall = 0.02,
                 kBargeMass = 200;
constexpr double kBargeInner = 1.96 * 0.96, kCapacity = kBargeInner * 0.48;

/// `above_keel`: of the centre of mass [m].
inline FloatingDef bargeDef(double above_keel, const OpenBarge& barge = {}) {
  FloatingDef def{openBarge(barge)};
  def.specific_gravity = kBargeMass / (1000 * def.shape.volume);
  def.centre_of_mass = {0, 0, above_keel - kBargeHeight / 2};
  return def;
}

inline double draughtOf(double water) {
  return (kBargeMass / 1000 + water) / (kBargeLength * kBargeWidth);
}

/// Sets a body upright afloat, heeled about x by an angle.
inline void setAfloat(FloatingRun& run, double above_keel, double heel) {
  const double water = run.water.empty() ? 0 : run.water[0].volume;
  run.state.orientation = rotationFromVector(Vector3(heel, 0, 0));
  double low = -1, high = 1;
  for (int i = 0; i < 60; ++i) {  // the net displacement falls with the height
    run.state.position = {0, 0, (low + high) / 2};
    const bool is_deep = wetVolume(run.model(), run.flotation()).volume > kBargeMass / 1000;
    (is_deep ? low : high) = (low + high) / 2;
  }
  if (heel == 0) {
    EXPECT_NEAR(run.state.position.z(), above_keel - draughtOf(water), 1e-12);
  }
}

}  // namespace ambient::test::barge
