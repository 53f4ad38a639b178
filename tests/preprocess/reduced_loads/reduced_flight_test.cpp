#include <gtest/gtest.h>

#include "preprocess/reduced_loads/reduced_loads.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

const double kRightAngle = std::acos(0.0);

// Plate with levels, built once per program.
const FluidBody& plateWithLevels() {
  static const FluidBody plate = [] {
    FluidBody body = test::meshedEllipsoid({0.05, 0.05, 0.01}, 3);
    body.levels = buildLoadLevels(body, {48, 96});
    return body;
  }();
  return plate;
}

BodyModel modelWith(const FluidBody& body, double error, double angle = kRightAngle) {
  FlowSettings flow;
  flow.law = PressureLaw::kPublished;  // its levels are clusters
  flow.maximum_load_error = error;
  flow.separation_angle = angle;
  return test::modelOf({body, {1, Matrix3::Identity()}, air(), flow});
}

TEST(ReducedFlight, TakesTheCheapestLevelThatKeepsTheError) {
  const FluidBody& body = plateWithLevels();
  const auto cost = [](const FluidBody& of, double error, double angle = kRightAngle) {
    return modelWith(of, error, angle).loads->faces();
  };
  const int all = static_cast<int>(body.faces.size());
  EXPECT_EQ(cost(body, 0), all);
  EXPECT_EQ(cost(body, 1), body.levels[0].clusters);
  EXPECT_EQ(cost(body, body.levels[1].error.p99), body.levels[1].clusters);
  EXPECT_EQ(cost(body, 0.5 * body.levels[1].error.p99), all);
  EXPECT_EQ(cost(body, 1, 1.2 * kRightAngle), all);  // fitted for another angle
  FluidBody small = test::meshedEllipsoid({1, 1, 0.2}, 1);
  small.levels = buildLoadLevels(small, {48});
  EXPECT_EQ(cost(small, 1), 80);  // cheaper
  EXPECT_THROW(modelWith(body, -1), std::invalid_argument);
}

TEST(ReducedFlight, OfAFlutteringPlateStaysNearTheOneOnAllFaces) {
  const auto end = [](double error) {
    FlowSettings flow;
    flow.law = PressureLaw::kPublished;
    flow.maximum_load_error = error;
    const double mass = 2e-4;
    test::FreeBody plate({plateWithLevels(),
                          {mass, test::ellipsoidMoments({0.05, 0.05, 0.01}, mass).asDiagonal()},
                          air(),
                          flow});
    plate.setGravity({0, 0, -9.81});
    plate.state.orientation =
        Quaternion(Eigen::AngleAxisd(85.0 / 90 * kRightAngle, Vector3::UnitY()));
    plate.advance(1.0 / 240, 240);
    return plate.state.position;
  };
  const Vector3 exact = end(0);
  EXPECT_GT(exact.norm(), 0.3);
  EXPECT_LT((end(0.02) - exact).norm(), 0.01);  // a tenth of the diameter
}

TEST(ReducedFlight, GainsNoEnergy) {
  const FluidBody& body = plateWithLevels();
  const BodyModel model = modelWith(body, 1);
  ASSERT_LT(model.loads->faces(), static_cast<int>(body.faces.size()));
  test::Arbitrary arbitrary(71);
  for (int i = 0; i < 2000; ++i) {
    const Twist x = arbitrary.twist(20, 1);
    const Wrench load = computeSurfaceLoad(model, x).wrench;
    EXPECT_LE(load.vector().dot(x.vector()), 1e-12 * load.vector().norm() * x.vector().norm());
  }
}

}  // namespace
}  // namespace ambient
