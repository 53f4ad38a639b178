#include <gtest/gtest.h>

#include "tests/preprocess/builder/floating_swing.h"

namespace ambient {
namespace {

using test::bodyOfShape;
using test::expectSwing;
using test::floatingDef;
using test::FloatingDef;
using test::FloatingRun;
using test::halfSubmerged;
using test::swingOf;

FluidBody barge() { return bodyOfShape(R"({"type": "box", "size": [2, 1, 0.5], "faces": 300})"); }
FluidBody cube() { return bodyOfShape(R"({"type": "box", "size": [1, 1, 1], "faces": 300})"); }

TEST(Floating, AddedMassIsThatOfImageBoundaryElementsAndItsKnownError) {
  // Heave and surge at infinite frequency by Capytaine 3.0, and the error of eq. (60) relative to
  // them.
  struct Case {
    const char* shape;
    double heave, heave_error, surge, surge_error;
  };
  const Case cases[] = {
      {R"({"type": "box", "size": [2, 1, 0.5], "faces": 300})", 0.7878, -0.10, 0.0465, 0.83},
      {R"({"type": "box", "size": [1, 1, 1], "faces": 300})", 0.3213, -0.11, 0.1588, 0.48},
      {R"({"type": "box", "size": [4, 4, 0.2], "faces": 300})", 16.0031, -0.10, 0.0345, 0.90},
      {R"({"type": "ellipsoid", "semi_axes": [1.5, 0.75, 0.5]})", 1.3047, -0.15, 0.0919, 0.38}};
  for (const Case& c : cases) {
    const FluidBody body = bodyOfShape(c.shape);
    ASSERT_FALSE(body.added_mass_parts.empty());
    const Matrix6 K = halfSubmerged(body);
    EXPECT_NEAR(K(5, 5), (1 + c.heave_error) * c.heave, 0.03 * c.heave) << c.shape;
    EXPECT_NEAR(K(3, 3), (1 + c.surge_error) * c.surge, 0.03 * c.surge) << c.shape;
    // Without weights K would be half of the unbounded body's.
    EXPECT_NEAR(K(5, 5) / (0.5 * body.added_mass(5, 5)), 0.88, 0.05);
  }
}

TEST(Floating, HeavesAsLinearTheorySays) {
  // Cummins' equation with Capytaine's coefficients; periods in sqrt(L/g), L the root of the
  // waterplane's area.
  FloatingRun box(floatingDef(barge(), 2, 1));
  box.state.position.z() = 0.01;
  const auto height = [](FloatingRun& run) { return [&run] { return run.state.position.z(); }; };
  const double root = std::sqrt(std::sqrt(2.0) / 9.81);
  expectSwing(swingOf(box, 4, height(box)), {{-0.82, 0.52, -0.33, 0.22}, 4.12 * root}, 0.05);
  FloatingRun die(floatingDef(cube(), 1, 1));
  die.state.position.z() = 0.01;
  expectSwing(swingOf(die, 5, height(die)), {{-0.94, 0.82, -0.71, 0.62}, 5.63 / std::sqrt(9.81)},
              0.05);
}

TEST(Floating, RollsAndPitchesAsLinearTheorySays) {
  const FluidBody body = barge();
  const double root = std::sqrt(std::sqrt(2.0) / 9.81), angle = 0.02;
  const auto tilt = [](FloatingRun& run, int axis) {
    return [&run, axis] { return run.state.orientation.toRotationMatrix()(2, axis); };
  };
  FloatingRun roll(floatingDef(body, 2, 1));
  roll.state.orientation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX());
  expectSwing(swingOf(roll, 5, tilt(roll, 1)), {{-1.00, 0.99, -0.98, 0.97}, 5.37 * root}, 0.05);
  FloatingRun pitch(floatingDef(body, 2, 1));
  pitch.state.orientation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY());
  expectSwing(swingOf(pitch, 5, tilt(pitch, 0)), {{-0.97, 0.90, -0.83, 0.77}, 4.75 * root}, 0.05);
}

}  // namespace
}  // namespace ambient
