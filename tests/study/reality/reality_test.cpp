// Measured bodies by both pressure laws: closed forms of docs/theory.md section 11, and the law
// nearer to the measurements.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "preprocess/shape/json_schema.h"
#include "tests/study/reality/falling_cases.h"
#include "tests/study/reality/measured_shapes.h"

namespace ambient {
namespace {

constexpr PressureLaw kPublished = PressureLaw::kPublished, kForm = PressureLaw::kForm;

const std::string kData = std::string(AMBIENT_DATA) + "/reality/";

nlohmann::json measurements() {
  const std::string file = kData + "measurements.json";
  return parseJson(readBytes(file), file).at("rows");
}

std::vector<FallingCase> fallsOf(const std::string& group) {
  return readFallingCases(kData + "falls.json", group);
}

const FluidBody& solvedShape(const std::string& type, double size) {
  return measuredShape({{"type", type}, {"size", size}});
}

double coefficient(const std::string& shape, const nlohmann::json& flow, PressureLaw law) {
  return computeCoefficient(solvedShape(shape, 1), readMeasuredFlow(flow), law);
}

double coefficient(const nlohmann::json& row, PressureLaw law) {
  return computeCoefficient(measuredShape(row.at("shape")), readMeasuredFlow(row.at("flow")), law);
}

TEST(MeasuredCoefficients, AreTheClosedFormsWithLittleFriction) {
  const nlohmann::json squarely{{"of", "drag"}, {"velocity", {0, 0, 1}}};
  EXPECT_NEAR(coefficient("cube", squarely, kForm), 1.17 + 0.0025, 5e-4);  // layers on its sides
  EXPECT_NEAR(coefficient("cube", squarely, kPublished), 0, 1e-3);
  EXPECT_NEAR(coefficient("disc", squarely, kForm), 1.17, 1e-3);
  const nlohmann::json thirty{{"of", "normal"}, {"incidence", 30}};
  EXPECT_NEAR(coefficient("plate", thirty, kForm), 1.328, 0.05);  // Eiffel 1911
  EXPECT_NEAR(coefficient("plate", thirty, kPublished), 0.75, 1e-3);
  EXPECT_EQ(coefficient("plate", {{"of", "stall angle"}}, kPublished), 0.5);
}

TEST(MeasuredCoefficients, LiftOfAPlateIsItsNormalForceAcrossTheMotion) {
  for (const PressureLaw law : {kPublished, kForm}) {
    const double normal = coefficient("plate", {{"of", "normal"}, {"incidence", 30}}, law);
    const double lift = coefficient("plate", {{"of", "lift"}, {"incidence", 30}}, law);
    EXPECT_NEAR(lift, normal * std::sqrt(0.75), 0.01 * normal);
  }
}

TEST(MeasuredCoefficients, OfBallsByThePublishedLawHaveNoReynoldsNumber) {
  const nlohmann::json lift{{"of", "lift"}, {"spin", 0.3}}, drag{{"of", "drag"}, {"spin", 0.3}};
  EXPECT_NEAR(coefficient("ball", lift, kPublished), 0.4, 5e-3);
  EXPECT_NEAR(coefficient("ball", drag, kPublished), 0.5 + 0.75 * 0.09, 1e-2);
}

TEST(MeasuredCoefficients, OfBallsAreTheClosedFormsAtTheirReynoldsNumber) {
  const auto drag = [](double reynolds, double roughness) {
    return coefficient("ball", {{"of", "drag"}, {"reynolds", reynolds}, {"roughness", roughness}},
                       kForm);
  };
  EXPECT_NEAR(drag(100, 0), 1.0767, 5e-4);
  EXPECT_NEAR(drag(1e5, 0), 0.49568, 1e-4);
  EXPECT_NEAR(drag(1e6, 0), 0.12223, 1e-4);
  EXPECT_NEAR(drag(1e5, 5e-3), 0.23285, 1e-4);
}

TEST(MeasuredCoefficients, ABodySettlesAtTheSpeedOfItsDrag) {
  const MeasuredFlow flow = readMeasuredFlow({{"of", "drag"}, {"reynolds", 1}});
  const FluidBody& ball = solvedShape("ball", 1);
  EXPECT_NEAR(computeSettling(ball, flow, 27.24, kForm), 1, 1e-3);
  EXPECT_NEAR(computeSettling(ball, flow, 2 * 27.24, kForm), 1.85, 0.05);  // Re 1.85
}

TEST(MeasuredCoefficients, RefuseWhatIsNotKnown) {
  EXPECT_THROW(makeMeasuredShape({{"type", "brick"}}), std::invalid_argument);
  EXPECT_THROW(readMeasuredFlow({{"of", "colour"}}), std::invalid_argument);
}

TEST(MeasuredShapes, HaveTheirVolumes) {
  EXPECT_NEAR(solvedShape("cuboctahedron", 1).volume, 20.0 / 3, 1e-12);
  EXPECT_NEAR(solvedShape("octahedron", 1).volume, 4.0 / 3, 1e-12);
  EXPECT_NEAR(solvedShape("tetrahedron", 1).volume, 8.0 / 3, 1e-12);
  EXPECT_NEAR(solvedShape("triangular rod", 1).volume, 100 * std::sqrt(3.0) / 4, 1e-10);
  EXPECT_NEAR(solvedShape("hexagonal rod", 1).volume, 100 * std::sqrt(27.0) / 8, 1e-10);
  EXPECT_NEAR(solvedShape("elliptic rod", 2).volume, 50 * std::acos(-1.0), 2);  // facets
  EXPECT_NEAR(solvedShape("aerofoil rod", 0.15).volume, 100 * 0.15 * 0.68, 0.2);
  EXPECT_NEAR(solvedShape("delta", 2).area, 2 * 0.5, 0.01);
  EXPECT_NEAR(solvedShape("hemisphere", 1).volume, std::acos(-1.0) / 12, 1e-3);
}

TEST(Measurements, CanBeComputedOneAndAll) {
  std::set<nlohmann::json> shapes;
  int count = 0;
  for (const nlohmann::json& row : measurements()) {
    EXPECT_TRUE(row.at("verified").is_boolean() && row.at("source").is_string()) << row.at("id");
    if (!row.contains("flow")) continue;
    EXPECT_NO_THROW(readMeasuredFlow(row["flow"])) << row["id"];
    EXPECT_GT(row.at("value").get<double>(), 0) << row["id"];
    shapes.insert(row.at("shape"));
    ++count;
  }
  EXPECT_GE(count, 100);
  for (const nlohmann::json& shape : shapes) EXPECT_NO_THROW(measuredShape(shape)) << shape;
}

TEST(Measurements, CurvesHaveTheirColumnsSourcesAndFlows) {
  const std::string file = kData + "curves.json";
  const nlohmann::json curves = parseJson(readBytes(file), file);
  for (const nlohmann::json& set : curves.at("sets")) {
    EXPECT_TRUE(curves.at("sources").contains(set.at("source"))) << set.at("id");
    EXPECT_NO_THROW(readMeasuredFlow(set.at("flow"))) << set.at("id");
    EXPECT_TRUE(!set.value("settles", false) || set.at("flow").at("of") == "drag") << set.at("id");
    EXPECT_EQ(set.at("columns").at(0), "reynolds") << set.at("id");
    EXPECT_EQ(set.at("columns").at(1), "value") << set.at("id");
    for (const nlohmann::json& point : set.at("points")) {
      EXPECT_EQ(point.size(), set.at("columns").size()) << set.at("id");
      EXPECT_TRUE(point.at(0) > 0 && point.at(1) > 0) << set.at("id") << point;
    }
  }
}

TEST(Measurements, DrawnOnesHaveTheirBodies) {
  std::set<std::string> bodies;
  for (const FallingCase& c : fallsOf("drawn")) bodies.insert(c.family + "/" + c.name);
  const std::set<std::string> known{"descent", "reach", "mode"};
  int coefficients = 0, motions = 0;
  for (const nlohmann::json& row : measurements()) {
    if (row.at("fitted") != "drawn") continue;
    EXPECT_TRUE(row.at("verified").get<bool>()) << row["id"];
    ++(row.contains("flow") ? coefficients : motions);
    if (row.contains("flow")) continue;
    const nlohmann::json& motion = row.at("motion");
    const std::string family = motion.at("family"), name = motion.at("name");
    EXPECT_EQ(bodies.count(family + "/" + name), 1u) << row["id"];
    EXPECT_EQ(known.count(motion.at("what")), 1u) << row["id"];
    EXPECT_EQ(row.at("value").is_array(), motion.at("what") == "mode") << row["id"];
  }
  EXPECT_GE(coefficients, 20);
  EXPECT_GE(motions, 10);
}

TEST(Measurements, AreNearerToTheFormLaw) {
  const std::set<std::string> chosen{"eiffel_plate_3",   "cube_face",       "cube_edge",
                                     "cyl_axial_0p5",    "cyl_cross_3",     "hl_octahedron",
                                     "eiffel_cn_ar1_12", "eiffel_press_60", "halfcyl_convex"};
  double published = 0, form = 0;
  std::size_t count = 0;
  for (const nlohmann::json& row : measurements()) {
    if (chosen.count(row.at("id").get<std::string>()) == 0) continue;
    const auto error = [&](PressureLaw law) {
      return std::log(std::max(coefficient(row, law), 0.02) / row.at("value").get<double>());
    };
    published += std::pow(error(kPublished), 2);
    form += std::pow(error(kForm), 2);
    ++count;
  }
  ASSERT_EQ(count, chosen.size());
  EXPECT_LT(std::sqrt(form / static_cast<double>(count)), 0.2);
  EXPECT_GT(std::sqrt(published / static_cast<double>(count)), 1);
}

TEST(Falls, ACardTumblesByTheFormLaw) {
  const FallingCase card = fallsOf("cards").front();
  const FallingRun run = runFall(card, kForm);
  EXPECT_EQ(run.fall.mode, FallingMode::kTumbling);
  EXPECT_NEAR(run.fall.descent_speed, 1.0, 0.05);
  EXPECT_EQ(run.coarse, 0);
}

TEST(Falls, ReachIsTheHorizontalDistanceAtTheDepth) {
  const FallingCase coin = fallsOf("drawn").front();
  const FallingRun run = runFall(coin, kForm);
  const auto deep = std::find_if(run.motion.begin(), run.motion.end(), [&](const MotionSample& s) {
    return s.position.z() < -coin.depth;
  });
  ASSERT_NE(deep, run.motion.end());
  std::istringstream line(fallLine(coin, kForm, run)), header(fallHeader());
  std::string cell, title;
  while (title != "reach" && std::getline(header, title, ',')) std::getline(line, cell, ',');
  EXPECT_NEAR(std::stod(cell), deep->position.head<2>().norm(), 1e-4);
}

TEST(Falls, ACubeOfWoodRisesByTheFormLawAtOneSubstepPerStep) {
  const FallingCase cube = fallsOf("cubes and balls").front();
  const FallingRun run = runFall(cube, kForm);
  // 0.94 of the terminal speed of a drag coefficient 1.05, measured face on.
  EXPECT_NEAR(run.fall.descent_speed, -0.576, 0.003);
  EXPECT_LT(run.substeps, 1.2);
}

}  // namespace
}  // namespace ambient
