#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/shape/shape_reader.h"
#include "preprocess/waterline/waterline_builder.h"
#include "tests/support/floating_runs.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

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

void expectSwing(const Swing& swing, const Swing& theory, double period_error) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(swing.extremes[i], theory.extremes[i], 0.06) << i;
  EXPECT_NEAR(swing.period, theory.period, period_error * theory.period)
      << swing.period / theory.period;
}

/// Gyration of 0.4 of the widths B_i = sqrt(12 I_i / A_w), centre of mass in the waterline.
FloatingDef floatingDef(const FluidBody& body, double length, double breadth) {
  FloatingDef def{body};
  def.gyration = 0.4 * Vector3(breadth, length, length);
  return def;
}

/// Body of a shape in JSON, with 1200 panels at most.
FluidBody bodyOfShape(const std::string& shape, ShapeBuildSettings settings = {}) {
  settings.flow.max_panels = 1200;
  return buildShape(readShape(nlohmann::json::parse(shape), "", "shape.json"), settings).body;
}

/// Added mass of a half-submerged body, z axis up.
Matrix6 halfSubmerged(const FluidBody& body) {
  FloatingDef def{body};
  const FloatingRun run(def);
  return run.model().wetted->inertia(run.immersion());
}

FluidBody bodyWith(const std::string& shape, int subdivisions) {
  ShapeBuildSettings settings;
  settings.waterline_subdivisions = subdivisions;
  return bodyOfShape(shape, settings);
}

constexpr const char* kCube = R"({"type": "box", "size": [1, 1, 1], "faces": 300})";
constexpr const char* kBarge = R"({"type": "box", "size": [2, 1, 0.5], "faces": 300})";

// Tables of all divisions have the node of the half submerged barge.
FluidBody tabledBarge(const WaterlineSettings& settings) {
  FluidBody made = bodyWith(kBarge, 0);
  made.waterline = makeWaterlineTable(made, settings);
  return made;
}

const FluidBody& bargeWithTable() {
  static const FluidBody body = tabledBarge({2, 350, 0});
  return body;
}

const FluidBody& bargeWithCoarseTable() {
  static const FluidBody body = tabledBarge({1, 100, 1});
  return body;
}

// Heave, roll, sway and surge by Capytaine 3.0 at infinite frequency, finer meshes.
TEST(Waterline, AddedMassIsThatOfAnotherBoundaryElementMethod) {
  FluidBody body = bodyWith(kCube, 0);
  body.waterline = makeWaterlineTable(body, {1, 600, 0});
  const Matrix6 cube = halfSubmerged(body);
  EXPECT_NEAR(cube(5, 5), 0.3213, 0.01 * 0.3213);
  EXPECT_NEAR(cube(3, 3), 0.1588, 0.03 * 0.1588);
  EXPECT_NEAR(cube(0, 0), 0.0201, 0.05 * 0.0201);
  const Matrix6 barge = halfSubmerged(bargeWithTable());
  EXPECT_NEAR(barge(5, 5), 0.7837, 0.01 * 0.7837);
  EXPECT_NEAR(barge(0, 0), 0.0268, 0.05 * 0.0268);
  EXPECT_NEAR(barge(1, 1), 0.1610, 0.02 * 0.1610);
  EXPECT_NEAR(barge(4, 4), 0.0958, 0.05 * 0.0958);
}

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

// Heave, roll and pitch of a barge by Cummins' equation with Capytaine's coefficients.
void expectSwingsOfBarge(const FluidBody& body, double period_error) {
  const double root = std::sqrt(std::sqrt(2.0) / 9.81);
  FloatingRun heave(floatingDef(body, 2, 1)), roll = heave, pitch = heave;
  heave.state.position.z() = 0.01;
  expectSwing(swingOf(heave, 4, [&] { return heave.state.position.z(); }),
              {{-0.82, 0.52, -0.33, 0.22}, 4.12 * root}, period_error);
  const auto tilt = [](FloatingRun& run, int axis) {
    return [&run, axis] { return run.state.orientation.toRotationMatrix()(2, axis); };
  };
  roll.state.orientation = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX());
  expectSwing(swingOf(roll, 5, tilt(roll, 1)), {{-1.00, 0.99, -0.98, 0.97}, 5.37 * root},
              period_error);
  pitch.state.orientation = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY());
  expectSwing(swingOf(pitch, 5, tilt(pitch, 0)), {{-0.97, 0.90, -0.83, 0.77}, 4.75 * root},
              period_error);
}

TEST(Waterline, PeriodsAreThoseOfLinearTheory) {
  expectSwingsOfBarge(bargeWithTable(), 0.02);
  expectSwingsOfBarge(bodyWith(kBarge, 0), 0.05);
}

// Bodies dropped on an edge, and released at depth with spin, in long and short steps.
TEST(Waterline, ABodyWithATableGainsNoEnergy) {
  for (const double gravity : {0.02, 0.5})
    for (const double step : {1.0 / 30, 1.0 / 240})
      for (const double height : {1.5, -2.0}) {
        FloatingDef def{bargeWithCoarseTable(), gravity};
        FloatingRun run(def);
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
    return refusalOf([&] { bodyWith(shape, subdivisions); });
  };
  EXPECT_EQ(refusal(R"({"type": "sheet", "size": [1, 1]})", 1),
            "shape.json: a sheet cannot have a waterline table");
  EXPECT_EQ(refusal(R"({"type": "sphere", "radius": 1})", 1),
            "shape.json: a sphere needs no waterline table: all have the same one");
  EXPECT_EQ(refusal(kCube, 17),
            "shape.json: waterline subdivisions = 17 is not between 0 (no table) and 16");
}

}  // namespace
}  // namespace ambient::test
