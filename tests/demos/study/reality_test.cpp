// Measured bodies by both pressure laws: closed forms of docs/theory.md section 11, and which law
// is nearer to the measurements.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "demos/study/falling_run.h"
#include "demos/study/measured_coefficient.h"
#include "demos/study/measured_shapes.h"
#include "preprocess/shape/json_text.h"

namespace ambient {
namespace {

constexpr PressureLaw kPublished = PressureLaw::kPublished, kForm = PressureLaw::kForm;

nlohmann::json measurements() {
  const std::string file = std::string(AMBIENT_DATA) + "/reality/measurements.json";
  return parseJson(readBytes(file), file).at("rows");
}

double coefficient(const std::string& shape, const nlohmann::json& flow, PressureLaw law) {
  return computeCoefficient(makeMeasuredShape(shape, 1), readMeasuredFlow(flow), law);
}

double coefficient(const nlohmann::json& row, PressureLaw law) {
  const nlohmann::json& shape = row.at("shape");
  const FluidBody body =
      makeMeasuredShape(shape.at("type").get<std::string>(), shape.value("size", 1.0));
  return computeCoefficient(body, readMeasuredFlow(row.at("flow")), law);
}

TEST(MeasuredCoefficients, AreTheClosedFormsWithLittleFriction) {
  const nlohmann::json squarely{{"of", "drag"}, {"velocity", {0, 0, 1}}};
  EXPECT_NEAR(coefficient("cube", squarely, kForm), 1.17, 1e-3);
  EXPECT_NEAR(coefficient("cube", squarely, kPublished), 0, 1e-3);
  EXPECT_NEAR(coefficient("disc", squarely, kForm), 1.17, 1e-3);
  const nlohmann::json thirty{{"of", "normal"}, {"incidence", 30}};
  EXPECT_NEAR(coefficient("plate", thirty, kForm), 1.17 * 0.75, 1e-3);
  EXPECT_NEAR(coefficient("plate", thirty, kPublished), 0.75, 1e-3);
  EXPECT_EQ(coefficient("plate", {{"of", "stall angle"}}, kPublished), 0.5);
}

TEST(MeasuredCoefficients, OfBallsAreThoseOfBothLaws) {
  const nlohmann::json lift{{"of", "lift"}, {"spin", 0.3}}, drag{{"of", "drag"}, {"spin", 0.3}};
  for (const PressureLaw law : {kPublished, kForm}) {
    EXPECT_NEAR(coefficient("ball", lift, law), 0.4, 5e-3);
    EXPECT_NEAR(coefficient("ball", drag, law), 0.5 + 0.75 * 0.09, 1e-2);
  }
}

TEST(MeasuredCoefficients, RefuseWhatIsNotKnown) {
  EXPECT_THROW(makeMeasuredShape("brick", 1), std::invalid_argument);
  EXPECT_THROW(readMeasuredFlow({{"of", "colour"}}), std::invalid_argument);
}

TEST(MeasuredShapes, HaveTheirVolumes) {
  EXPECT_NEAR(makeMeasuredShape("cuboctahedron", 1).volume, 20.0 / 3, 1e-12);
  EXPECT_NEAR(makeMeasuredShape("octahedron", 1).volume, 4.0 / 3, 1e-12);
  EXPECT_NEAR(makeMeasuredShape("tetrahedron", 1).volume, 8.0 / 3, 1e-12);
  EXPECT_NEAR(makeMeasuredShape("triangular rod", 1).volume, 100 * std::sqrt(3.0) / 4, 1e-10);
  EXPECT_NEAR(makeMeasuredShape("hemisphere", 1).volume, std::acos(-1.0) / 12, 1e-3);
}

TEST(Measurements, CanBeComputedOneAndAll) {
  std::set<std::string> shapes;
  int count = 0;
  for (const nlohmann::json& row : measurements()) {
    EXPECT_TRUE(row.at("verified").is_boolean() && row.at("source").is_string()) << row.at("id");
    if (!row.contains("flow")) continue;
    EXPECT_NO_THROW(readMeasuredFlow(row["flow"])) << row["id"];
    EXPECT_GT(row.at("value").get<double>(), 0) << row["id"];
    shapes.insert(row.at("shape").at("type").get<std::string>());
    ++count;
  }
  EXPECT_GE(count, 100);
  for (const std::string& shape : shapes) EXPECT_NO_THROW(makeMeasuredShape(shape, 1)) << shape;
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
  const FallingCase card = makeFallingCases("cards").front();
  const FallingRun run = runFall(card, kForm);
  EXPECT_EQ(run.fall.mode, FallingMode::kTumbling);
  EXPECT_NEAR(run.fall.descent_speed, 0.81, 0.03);
  EXPECT_EQ(run.coarse, 0);
}

TEST(Falls, ACubeOfWoodRisesByTheFormLawAtOneSubstepPerStep) {
  const FallingCase cube = makeFallingCases("cubes and balls").front();
  const FallingRun run = runFall(cube, kForm);
  // 0.94 of the speed by its measured drag coefficient of 1.05, face on.
  EXPECT_NEAR(run.fall.descent_speed, -0.576, 0.003);
  EXPECT_LT(run.substeps, 1.2);
}

}  // namespace
}  // namespace ambient
