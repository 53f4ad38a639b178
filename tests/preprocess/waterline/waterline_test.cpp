#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "preprocess/waterline/waterline_builder.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/preprocess/builder/floating_swing.h"

namespace ambient {
namespace {

FluidBody bodyWith(const std::string& shape, int subdivisions) {
  ShapeBuildSettings settings;
  settings.waterline_subdivisions = subdivisions;
  return test::bodyOfShape(shape, settings);
}

constexpr const char* kCube = R"({"type": "box", "size": [1, 1, 1], "faces": 300})";
constexpr const char* kBarge = R"({"type": "box", "size": [2, 1, 0.5], "faces": 300})";

// Tables of all divisions have the node of the half submerged barge.
const FluidBody& bargeWithTable() {
  static const FluidBody body = [] {
    FluidBody made = bodyWith(kBarge, 0);
    made.waterline = makeWaterlineTable(made, {2, 350, 0});
    return made;
  }();
  return body;
}

const FluidBody& bargeWithCoarseTable() {
  static const FluidBody body = [] {
    FluidBody made = bodyWith(kBarge, 0);
    made.waterline = makeWaterlineTable(made, {1, 100, 1});
    return made;
  }();
  return body;
}

// Heave, roll, sway and surge by Capytaine 3.0 at infinite frequency, finer meshes.
TEST(Waterline, AddedMassIsThatOfAnotherBoundaryElementMethod) {
  FluidBody body = bodyWith(kCube, 0);
  body.waterline = makeWaterlineTable(body, {1, 600, 0});
  const Matrix6 cube = test::halfSubmerged(body);
  EXPECT_NEAR(cube(5, 5), 0.3213, 0.01 * 0.3213);
  EXPECT_NEAR(cube(3, 3), 0.1588, 0.03 * 0.1588);
  EXPECT_NEAR(cube(0, 0), 0.0201, 0.05 * 0.0201);
  const Matrix6 barge = test::halfSubmerged(bargeWithTable());
  EXPECT_NEAR(barge(5, 5), 0.7837, 0.01 * 0.7837);
  EXPECT_NEAR(barge(0, 0), 0.0268, 0.05 * 0.0268);
  EXPECT_NEAR(barge(1, 1), 0.1610, 0.02 * 0.1610);
  EXPECT_NEAR(barge(4, 4), 0.0958, 0.05 * 0.0958);
}

// Cummins' equation with Capytaine's coefficients, taken from floating_test.cpp, where periods
// agree within 4 %.
TEST(Waterline, PeriodsAreThoseOfLinearTheory) {
  const FluidBody& body = bargeWithTable();
  const double root = std::sqrt(std::sqrt(2.0) / 9.81);
  test::FloatingRun heave(test::floatingDef(body, 2, 1));
  heave.state.position.z() = 0.01;
  test::expectSwing(test::swingOf(heave, 4, [&] { return heave.state.position.z(); }),
                    {{-0.82, 0.52, -0.33, 0.22}, 4.12 * root}, 0.02);
  const auto tilt = [](test::FloatingRun& run, int axis) {
    return [&run, axis] { return run.state.orientation.toRotationMatrix()(2, axis); };
  };
  test::FloatingRun roll(test::floatingDef(body, 2, 1)), pitch(test::floatingDef(body, 2, 1));
  roll.state.orientation = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX());
  test::expectSwing(test::swingOf(roll, 5, tilt(roll, 1)),
                    {{-1.00, 0.99, -0.98, 0.97}, 5.37 * root}, 0.02);
  pitch.state.orientation = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY());
  test::expectSwing(test::swingOf(pitch, 5, tilt(pitch, 0)),
                    {{-0.97, 0.90, -0.83, 0.77}, 4.75 * root}, 0.02);
}

// Bodies dropped on an edge, and released at depth with spin, in long and short steps.
TEST(Waterline, ABodyWithATableGainsNoEnergy) {
  for (const double gravity : {0.02, 0.5})
    for (const double step : {1.0 / 30, 1.0 / 240})
      for (const double height : {1.5, -2.0}) {
        test::FloatingDef def;
        def.shape = bargeWithCoarseTable();
        def.specific_gravity = gravity;
        test::FloatingRun run(def);
        run.state.position.z() = height;
        run.state.orientation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 0.3, 0).normalized());
        run.state.twist = {{0.5, 1, -2}, {0.3, 0.2, 0}};
        const double scale = (run.mass() + 1000 * def.shape.volume) * 9.81;
        double energy = run.energy();
        for (int i = 0; i < 3 / step; ++i) {
          run.step(step);
          EXPECT_LE(run.energy() - energy, 1e-11 * scale) << gravity << ", " << step << ", " << i;
          energy = run.energy();
        }
      }
}

TEST(Waterline, TheTableIsTheSameOnAnyNumberOfThreadsAndTellsOfEachAttitude) {
  WaterlineSettings settings{1, 100, 3};
  std::vector<std::pair<int, int>> told;
  settings.progress = [&](int done, int attitudes) { told.emplace_back(done, attitudes); };
  const WaterlineTable table = makeWaterlineTable(bodyWith(kBarge, 0), settings);
  EXPECT_EQ(table.corrections, bargeWithCoarseTable().waterline.corrections);
  // Of the six directions of an octahedron, three are left to solve by the planes of symmetry.
  const std::vector<std::pair<int, int>> expected{{1, 3}, {2, 3}, {3, 3}};
  EXPECT_EQ(told, expected);
}

TEST(Waterline, SymmetriesOfTheBodyAreThoseOfTheTable) {
  const FluidBody body = bodyWith(kBarge, 0);
  const WaterlineTable table = makeWaterlineTable(body, {2, 100, 0});
  const OctahedralLattice lattice(2);
  const Vector6 mirror = (Vector6() << 1, -1, -1, -1, 1, 1).finished();
  const auto at = [&](const Vector3& direction, std::size_t immersion) -> const Matrix6& {
    int node = 0;
    while (lattice.direction(node) != direction) ++node;
    return table.corrections[node * table.immersions.size() + immersion];
  };
  for (std::size_t i = 0; i < table.immersions.size(); ++i) {
    const Matrix6& one = at({1, 0, 0}, i);
    const Matrix6 other = mirror.asDiagonal() * at({-1, 0, 0}, i) * mirror.asDiagonal();
    EXPECT_LT((one - other).norm(), 1e-12 * (1e-3 + one.norm()));
  }
}

TEST(Waterline, SaysWhatCannotHaveATable) {
  const auto refusal = [](const char* shape, int subdivisions) {
    return test::refusalOf([&] { bodyWith(shape, subdivisions); });
  };
  EXPECT_EQ(refusal(R"({"type": "sheet", "size": [1, 1]})", 1),
            "shape.json: a sheet cannot have a waterline table");
  EXPECT_EQ(refusal(R"({"type": "sphere", "radius": 1})", 1),
            "shape.json: a sphere needs no waterline table: all have the same one");
  EXPECT_EQ(refusal(kCube, 17),
            "shape.json: waterline subdivisions = 17 is not between 0 (no table) and 16");
}

}  // namespace
}  // namespace ambient
