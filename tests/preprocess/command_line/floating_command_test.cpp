#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "tests/preprocess/command_line/command_line.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/preprocess/mesh/vessel_meshes.h"

namespace ambient {
namespace {

using nlohmann::json;

class FloatingCommand : public CommandLine {
 protected:
  std::string barge() {
    const std::string box = write("barge.json", R"({"type":"box","size":[2,1,0.5]})");
    resultOf({"build", box, "-o", path("barge.ambient"), "--panels", "0", "--json"});
    return path("barge.ambient");
  }
};

// Barge of half the water's density, low weight: T = 0.25, GM = B^2 / 12 T - KG + KB.
TEST_F(FloatingCommand, InspectTellsHowABargeFloats) {
  const std::string file = barge();
  const Arguments floating{"inspect",          file, "--mass", "500",   "--density", "1000",
                           "--centre-of-mass", "0",  "0",      "-0.24", "--json"};
  json report = resultOf(floating);
  ASSERT_GE(report["floating"].size(), 1u);  // upright, possibly also on its side
  const json& upright = report["floating"][0];
  EXPECT_NEAR(upright["draught"].get<double>(), 0.25, 1e-9);
  EXPECT_NEAR(upright["up"][2].get<double>(), 1, 1e-9);
  EXPECT_NEAR(upright["height_of_mass"].get<double>(), -0.24, 1e-9);
  EXPECT_NEAR(upright["metacentres"][0]["height"].get<double>(), 1 / (12 * 0.25) + 0.24 - 0.125,
              1e-9);
  EXPECT_EQ(upright["modes"].size(), 3u);
  report.erase("floating");
  EXPECT_EQ(report, resultOf({"inspect", file, "--json"}));
  const std::string table = run({"inspect", file, "--mass", "500", "--density", "1000"}).output;
  EXPECT_NE(table.find("\n  draught         0.25 m\n"), std::string::npos) << table;
}

TEST_F(FloatingCommand, InspectTellsOfABodyUpsideDownAndOfOneLighterThanAir) {
  const std::string file = barge();
  const auto inspect = [&](const char* mass, const char* height) {
    return run({"inspect", file, "--mass", mass, "--centre-of-mass", "0", "0", height});
  };
  const std::string downwards = "\n  up              0, 0, -1\n";
  EXPECT_NE(inspect("500", "0.24").output.find(downwards), std::string::npos)
      << inspect("500", "0.24").output;
  EXPECT_EQ(inspect("500", "-0.24").output.find(downwards), std::string::npos);
  EXPECT_NE(inspect("0.5", "0").errors.find("it is lighter than the 1.2"), std::string::npos)
      << inspect("0.5", "0").errors;
}

TEST_F(FloatingCommand, PeriodsAreThoseOfTheInertiaThatIsGiven) {
  const std::string file = barge();
  const auto longest = [&](const Arguments& more) {
    const Arguments inspect{"inspect", file, "--mass", "500",   "--centre-of-mass",
                            "0",       "0",  "-0.24",  "--json"};
    return resultOf(appended(inspect, more))["floating"][0]["modes"][0]["period"].get<double>();
  };
  // 500 kg over a box of 2 m x 1 m x 0.5 m.
  const Arguments even{"--inertia",
                       std::to_string(500 / 12.0 * 1.25),
                       std::to_string(500 / 12.0 * 4.25),
                       std::to_string(500 / 12.0 * 5),
                       "0",
                       "0",
                       "0"};
  EXPECT_NEAR(longest(even), longest({}), 1e-6 * longest({}));
  EXPECT_GT(longest({"--inertia", "400", "700", "800", "0", "0", "0"}), 1.2 * longest({}));
  EXPECT_NE(refusal({"inspect", file, "--mass", "500", "--inertia", "-1", "1", "1", "0", "0", "0"})
                .find("smallest principal moment"),
            std::string::npos);
}

TEST_F(FloatingCommand, InspectTellsThatABodySinks) {
  const std::string file = barge();
  EXPECT_TRUE(resultOf({"inspect", file, "--mass", "1001", "--json"})["floating"].empty());
  EXPECT_NE(run({"inspect", file, "--mass", "1001"}).errors.find("it sinks: it displaces 998 kg"),
            std::string::npos);
}

TEST_F(FloatingCommand, InspectSaysWhatIsWrong) {
  const std::string file = barge();
  EXPECT_NE(refusal({"inspect", file, "--mass", "-1"}).find("mass [kg] is -1; must be positive"),
            std::string::npos);
}

// Periods of body and water without waves: 2 pi sqrt(inertia / (density gravity geometry)).
TEST_F(FloatingCommand, InspectHasThePeriodsOfTheGravityThatIsGiven) {
  const std::string file = barge();
  const auto upright = [&](const char* gravity) {
    return resultOf({"inspect", file, "--mass", "500", "--gravity", gravity, "--json"})
        .at("floating")
        .at(0);
  };
  const json here = upright("9.81"), moon = upright("1.62");
  EXPECT_EQ(resultOf({"inspect", file, "--mass", "500", "--json"}).at("floating").at(0), here);
  EXPECT_NEAR(moon["draught"].get<double>(), here["draught"].get<double>(), 1e-12);
  ASSERT_EQ(here["modes"].size(), 3u);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(moon["modes"][i]["period"].get<double>() / here["modes"][i]["period"].get<double>(),
                std::sqrt(9.81 / 1.62), 1e-9)
        << i;
}

/// The attitude of the smallest tilt.
json upright(const json& facts) {
  json best;
  for (const json& attitude : facts["floating"])
    if (best.is_null() || attitude["up"][2] > best["up"][2]) best = attitude;
  return best;
}

// What is read of an .obj file has the rounding of float.
TEST_F(FloatingCommand, TrayStaysDryUnlessItIsToldNotTo) {
  const auto factsOf = [](const Arguments& arguments) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return json::parse(result.output);
  };
  const std::string mesh = write("tray.obj", objText(makeBarge({1, 0.6, 0.4, 0.02})));
  const json checked = factsOf({"check", mesh, "--json"});
  ASSERT_EQ(checked["holds"].size(), 1u);
  EXPECT_NEAR(checked["holds"][0]["volume"].get<double>(), 0.96 * 0.56 * 0.38, 1e-8);
  EXPECT_NEAR(checked["holds"][0]["openings"][0]["rim"].get<double>(), 3.04, 1e-6);
  const std::string file = path("tray.ambient");
  const json built = factsOf({"build", mesh, "-o", file, "--panels", "0", "--json"});
  EXPECT_EQ(built["holds"].size(), 1u);
  const Arguments inspect = {"inspect", file, "--mass", "60", "--json"};
  const double draught = 60 / (998 * 0.6);
  EXPECT_NEAR(upright(resultOf(inspect))["draught"].get<double>(), draught, 1e-7);
  EXPECT_NEAR(upright(resultOf(inspect))["freeboard"].get<double>(), 0.4 - draught, 1e-7);
  const json with_water = resultOf(appended(inspect, {"--water", "0.03"}));
  EXPECT_NEAR(upright(with_water)["draught"].get<double>(), draught + 0.05, 1e-4);
  // Upside down there is no room: the walls alone sink.
  for (const Arguments& option :
       {Arguments{"--holds", "none"}, Arguments{"--up", "0", "0", "-1"}}) {
    const Arguments build = {"build", mesh, "-o", file, "--panels", "0", "--json"};
    EXPECT_FALSE(factsOf(appended(build, option)).contains("holds"));
    EXPECT_TRUE(resultOf(inspect)["floating"].empty());
  }
}

}  // namespace
}  // namespace ambient
