// Motions at sea: numbers taken from series of which they are known, the file of measurements, and
// how near the library is to some of these.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "bullet_ambient/base/pi.h"
#include "tests/study/reality/sea_measure.h"
#include "tests/study/reality/sea_runs.h"

namespace ambient {
namespace {

using nlohmann::json;

CoordinateSeries sampled(const std::function<double(double)>& y, double duration) {
  CoordinateSeries series;
  for (int i = 0; i <= 4000; ++i) {
    series.times.push_back(duration * i / 4000);
    series.values.push_back(y(series.times.back()));
  }
  return series;
}

double number(json what, const CoordinateSeries& series) {
  what["along"] = "z";
  return measure(readMotionMeasure(what), series);
}

TEST(SeaMeasure, DampedSineHasItsPeriodExtremesAndDecay) {
  const double omega = 8, rate = 0.8;
  const auto y =
      sampled([&](double t) { return 3 + 0.1 * std::exp(-rate * t) * std::cos(omega * t); }, 4);
  const json about{{"balance", 3.0}, {"count", 4}};
  const auto with = [&](const char* of, int count) {
    json what = about;
    what["of"] = of;
    what["count"] = count;
    what["scale"] = 0.1;
    return number(what, y);
  };
  const double lag = std::atan(rate / omega) / omega, half = kPi / omega;
  EXPECT_NEAR(with("period", 4), 2 * half, 1e-5);
  EXPECT_NEAR(with("time of extreme", 1), half - lag, 1e-5);
  EXPECT_NEAR(with("decay", 6), rate, 1e-4);
  const double first = std::exp(-rate * (half - lag)) * std::cos(kPi - omega * lag);
  EXPECT_NEAR(with("extreme", 1), first, 1e-5);
  EXPECT_NEAR(with("extreme", 2), -first * std::exp(-rate * half), 1e-5);
  EXPECT_THROW(with("extreme", 99), std::runtime_error);
}

TEST(SeaMeasure, SineHasItsAmplitudeWhereverItsMiddleIs) {
  const auto y = sampled([](double t) { return 5 + 0.02 * std::sin(3 * t + 1); }, 2 * kPi);
  EXPECT_NEAR(
      number({{"of", "amplitude"}, {"period", 2 * kPi / 3}, {"count", 2}, {"scale", 0.01}}, y), 2,
      2e-3);
  EXPECT_NEAR(number({{"of", "mean"}, {"time", 2 * kPi / 3}}, y), 5, 1e-4);
  EXPECT_NEAR(number({{"of", "largest"}, {"balance", 5.0}}, y), 0.02, 1e-6);
  EXPECT_NEAR(number({{"of", "value"}, {"time", 0.5}}, y), 5 + 0.02 * std::sin(2.5), 1e-6);
}

// dw/dt = -x - kappa |w| w, integrated by small steps.
TEST(SeaMeasure, QuadraticDampingIsFoundAgain) {
  double x = 0.2, w = 0;
  const double kappa = 0.4, step = 1e-4;
  CoordinateSeries y;
  for (int i = 0; i < 100000; ++i) {
    y.times.push_back(i * step);
    y.values.push_back(x);
    w += step * (-x - kappa * std::abs(w) * w);
    x += step * w;
  }
  EXPECT_NEAR(number({{"of", "quadratic decay"}, {"count", 1}}, y), kappa, 0.01 * kappa);
}

TEST(SeaMeasure, RefusesWhatIsNotKnown) {
  EXPECT_THROW(readMotionMeasure({{"of", "colour"}, {"along", "z"}}), std::invalid_argument);
  EXPECT_THROW(seriesOf("w", {MotionSample{}}, 9.81), std::invalid_argument);
}

TEST(SeaMeasure, ABodyInFreeFallFeelsNothing) {
  std::vector<MotionSample> motion(3);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    motion[i].time = 0.1 * static_cast<double>(i);
    motion[i].twist.linear.z() = -9.81 * motion[i].time;
  }
  const CoordinateSeries felt = seriesOf("felt", motion, 9.81);
  ASSERT_EQ(felt.values.size(), 2u);
  for (const double value : felt.values) EXPECT_NEAR(value, 0, 1e-12);
}

class SeaMeasurements : public testing::Test {
 protected:
  static SeaRuns& runs() {
    static SeaRuns all(std::string(AMBIENT_DATA) + "/reality/measurements_at_sea.json");
    return all;
  }

  /// Library over measured.
  static double ratio(const std::string& id) {
    for (const json& row : runs().rows())
      if (row.at("id") == id) return runs().compute(row) / row.at("value").get<double>();
    ADD_FAILURE() << id;
    return 0;
  }
};

TEST_F(SeaMeasurements, HaveTheirSourcesCasesAndNumbers) {
  const json& data = runs().data();
  std::set<std::string> ids;
  for (const json& row : runs().rows()) {
    EXPECT_TRUE(ids.insert(row.at("id")).second) << row["id"];
    EXPECT_TRUE(row.at("verified").get<bool>()) << row["id"];
    EXPECT_EQ(data.at("sources").count(row.at("source")), 1u) << row["id"];
    EXPECT_EQ(data.at("cases").count(row.at("case")), 1u) << row["id"];
    EXPECT_NE(row.at("value").get<double>(), 0) << row["id"];
    if (row.at("measure").at("of") == "added mass") continue;
    EXPECT_NO_THROW(readMotionMeasure(row["measure"])) << row["id"];
  }
  EXPECT_GE(ids.size(), 60u);
  for (const json& series : data.at("series"))
    EXPECT_EQ(data.at("cases").count(series.at("case")), 1u) << series["case"];
}

// Kramer et al. 2021. With the drag of steady motion the first troughs are 0.93, 0.84 and 0.73 of
// the measured ones.
TEST_F(SeaMeasurements, ABallHeavesAsMeasured) {
  EXPECT_NEAR(ratio("kramer_30_time"), 1, 0.02);
  EXPECT_NEAR(ratio("kramer_150_time"), 1, 0.02);
  EXPECT_NEAR(ratio("kramer_30_extreme_1"), 1, 0.03);
  EXPECT_NEAR(ratio("kramer_90_extreme_1"), 1, 0.03);
  EXPECT_NEAR(ratio("kramer_150_extreme_1"), 1, 0.12);
  EXPECT_NEAR(ratio("kramer_30_extreme_2"), 1, 0.03);
  EXPECT_NEAR(ratio("kramer_90_extreme_2"), 1, 0.07);
  EXPECT_GT(ratio("kramer_30_decay"), 0.85);
  EXPECT_GT(ratio("kramer_150_decay"), 0.8);
}

TEST_F(SeaMeasurements, FloatingBodiesHaveTheirNaturalPeriods) {
  for (const char* id : {"ship_heave_period", "ship_roll_period", "caisson_period"})
    EXPECT_NEAR(ratio(id), 1, 0.06) << id;
}

TEST_F(SeaMeasurements, AConeFeelsTheWaterAsMeasured) {
  EXPECT_NEAR(ratio("cone_45_50cm"), 1, 0.1);
  EXPECT_NEAR(ratio("cylinder_40ms"), 1, 0.1);
}

TEST_F(SeaMeasurements, ABargeThatIsTopHeavyRestsAtItsAngleOfLoll) {
  EXPECT_NEAR(ratio("barge_20"), 1, 0.01);
  EXPECT_NEAR(ratio("barge_30"), 1, 0.01);
}

}  // namespace
}  // namespace ambient
