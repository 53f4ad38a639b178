#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/resistance/prepare.h"
#include "tests/preprocess/command_line/command_line.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/preprocess/mesh/vessel_meshes.h"

namespace ambient {
namespace {

using nlohmann::json;

TEST_F(CommandLine, LoadsAreThoseOfTheForceModel) {
  const std::string box = write("box.json", R"({"type":"box","half_sizes":[1,2,3],"faces":300})");
  resultOf({"build", box, "-o", path("b.ambient"), "--panels", "0", "--json"});
  const json loads = resultOf({"loads", path("b.ambient"), "--twist", "0.1", "-2", ".3", "-1e-1",
                               "-.5", "6", "--density", "1.2", "--viscosity", "1.8e-5",
                               "--separation-angle", "2", "--law", "published", "--json"});
  const FluidBody body = readFluidBody(path("b.ambient"));
  LoadSettings settings;
  settings.density = 1.2;
  settings.viscosity = 1.8e-5;
  settings.separation_cosine = std::cos(2.0);
  const Twist twist{{0.1, -2, 0.3}, {-0.1, -0.5, 6}};
  const FaceLoads expected = computeFaceLoads(body.faces, std::sqrt(body.area), twist, settings);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(loads["pressure"][i].get<double>(), expected.pressure.vector()[i]);
    EXPECT_EQ(loads["friction"][i].get<double>(), expected.friction.vector()[i]);
    EXPECT_EQ(loads["total"][i].get<double>(), expected.total().vector()[i]);
  }
  EXPECT_LT(loads["friction"][5].get<double>(), 0);
  EXPECT_LT(loads["pressure"][5].get<double>(), 0);
}

TEST_F(CommandLine, LoadsSeparateAtARightAngleByDefault) {
  resultOf({"build", write("ball.json", R"({"type":"sphere","radius":0.5})"), "-o",
            path("b.ambient"), "--json"});
  const Arguments motion{"loads", path("b.ambient"), "--twist", "0",     "0", "0", "0", "0",
                         "2",     "--density",       "3",       "--json"};
  const json loads = resultOf(motion);
  // C_D = 1/2 on pi R^2, the integral of sin^4(alpha) / 2; facets have no influence.
  const double drag = 0.5 * 3 * 2 * 2 * 0.5 * 3.14159265358979324 * 0.25;
  EXPECT_NEAR(loads["pressure"][5].get<double>(), -drag, 1e-12 * drag);
  EXPECT_EQ(loads["friction"][5].get<double>(), 0) << "no viscosity, no friction";
  EXPECT_EQ(resultOf(appended(motion, {"--separation-angle", "1.5707963"})), loads);
  EXPECT_EQ(resultOf(appended(motion, {"--no-friction"})), loads);
}

TEST_F(CommandLine, LoadsOnASphereAboutAnotherOriginAreThoseAtItsCentre) {
  const std::string ball = write("ball.json", sphereText());
  resultOf({"build", ball, "-o", path("b.ambient"), "--json"});
  resultOf({"build", ball, "-o", path("off.ambient"), "--origin", "0,0,-2", "--json"});
  const auto loadsOf = [&](const std::string& file, const char* vx) {
    return resultOf({"loads", path(file), "--twist", "0", "3", "1", vx, "0", "5", "--density", "2",
                     "--viscosity", "1e-3", "--roughness", "1e-3", "--json"})["total"];
  };
  // Centre at (0, 0, 2): its velocity is v + w x r, 6 m/s more along x.
  const json centred = loadsOf("b.ambient", "7"), off = loadsOf("off.ambient", "1");
  const auto at = [](const json& loads, int i) { return loads[i].get<double>(); };
  for (int i = 3; i < 6; ++i) EXPECT_NEAR(at(off, i), at(centred, i), 1e-12) << i;
  EXPECT_NEAR(at(off, 0), at(centred, 0) - 2 * at(centred, 4), 1e-12);
  EXPECT_NEAR(at(off, 1), at(centred, 1) + 2 * at(centred, 3), 1e-12);
  EXPECT_NEAR(at(off, 2), at(centred, 2), 1e-12);
  EXPECT_GT(std::abs(at(centred, 3)), 1);
}

TEST_F(CommandLine, LoadsOfTheFormLawPressOnAFlatFace) {
  const std::string box = write("box.json", R"({"type":"box","size":[1,1,1]})");
  resultOf({"build", box, "-o", path("b.ambient"), "--panels", "0", "--json"});
  const Arguments motion{"loads", path("b.ambient"), "--twist", "0",     "0", "0", "0", "0",
                         "2",     "--density",       "3",       "--json"};
  EXPECT_NEAR(resultOf(motion)["total"][5].get<double>(), -1.17 * 0.5 * 3 * 2 * 2, 1e-12);
  EXPECT_EQ(resultOf(appended(motion, {"--law", "form"})), resultOf(motion))
      << "form is the default";
  EXPECT_EQ(resultOf(appended(motion, {"--law", "published"}))["total"][5].get<double>(), 0);
}

TEST_F(CommandLine, LoadsOfTheFormLawHaveTheMeasuredDrag) {
  const std::string box = write("box.json", R"({"type":"box","size":[1,1,1]})");
  resultOf({"build", box, "-o", path("b.ambient"), "--panels", "0", "--drag", "1.05", "--json"});
  const json loads = resultOf({"loads", path("b.ambient"), "--twist", "0", "0", "0", "0", "2", "0",
                               "--density", "3", "--law", "form", "--json"});
  EXPECT_NEAR(loads["total"][4].get<double>(), -1.05 * 0.5 * 3 * 2 * 2, 1e-12);
  const ProgramResult ball =
      run({"build", write("ball.json", sphereText()), "-o", path("ball.ambient"), "--drag", "0.2"});
  EXPECT_NE(ball.errors.find("--drag needs faces"), std::string::npos) << ball.errors;
}

TEST_F(CommandLine, LoadsPrintATable) {
  resultOf({"build", write("ball.json", sphereText()), "-o", path("b.ambient"), "--json"});
  const ProgramResult loads =
      run({"loads", path("b.ambient"), "--twist", "0", "0", "0", "1", "0", "0", "--density", "1"});
  EXPECT_EQ(loads.exit_code, 0);
  EXPECT_EQ(loads.output.find("pressure "), 0u) << loads.output;
  EXPECT_NE(loads.output.find("\ntotal "), std::string::npos) << loads.output;
}

TEST_F(CommandLine, BadLoadsAreRefusedByName) {
  resultOf({"build", write("ball.json", sphereText()), "-o", path("b.ambient"), "--json"});
  expectUsageRefusals("options of loads", {"loads", path("b.ambient")});
  EXPECT_NE(refusal({"loads", path("b.ambient"), "--twist", "0", "0", "0", "1e200", "0", "0",
                     "--density", "1"})
                .find("beyond the largest number"),
            std::string::npos);
  const std::string overflow =
      refusal({"polar", path("b.ambient"), "--speed", "1e200", "--attack", "0"});
  EXPECT_NE(overflow.find("speed or reference is too large"), std::string::npos) << overflow;
}

// A file of an earlier version is written anew as prepare() completes it; one that cannot be read
// stays.
TEST_F(CommandLine, UpgradeCompletesFilesInPlace) {
  resultOf({"build", write("box.json", R"({"type":"box","half_sizes":[1,2,3]})"), "-o",
            path("new.ambient"), "--panels", "0", "--json"});
  FluidBody body = readFluidBody(path("new.ambient"));
  prepare(body);
  writeFluidBody(body, path("new.ambient"));
  body.form = {};
  body.viscous = {};
  writeFluidBody(body, path("old.ambient"));
  ASSERT_NE(bytesOfFile("old.ambient"), bytesOfFile("new.ambient"));
  for (const char* said : {": upgraded\n", ": is up to date\n"}) {
    const ProgramResult result = run({"upgrade", path("old.ambient")});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, path("old.ambient") + said);
    EXPECT_EQ(bytesOfFile("old.ambient"), bytesOfFile("new.ambient"));
  }
  const std::string half = bytesOfFile("new.ambient").substr(0, 3000);
  const std::size_t files = fileCount() + 1;
  EXPECT_NE(refusal({"upgrade", write("half.ambient", half)}).find("half.ambient"),
            std::string::npos);
  EXPECT_EQ(bytesOfFile("half.ambient"), half);
  EXPECT_EQ(fileCount(), files);
}

class Export : public CommandLine {
 protected:
  void SetUp() override {
    const ProgramResult built = run({"build", write("ball.json", sphereText()), "-o", ball()});
    ASSERT_EQ(built.exit_code, 0) << built.errors;
  }

  std::string ball() const { return path("ball.ambient"); }

  /// Arguments of an export of the ball to out.x.
  Arguments exporting(const std::string& format, const Arguments& more = {}) const {
    return appended({"export", ball(), "--format", format, "-o", path("out.x")}, more);
  }
};

TEST_F(Export, WritesToStandardOutputOrAFile) {
  for (const std::string format : {"sdf", "mjcf", "fossen"}) {
    const ProgramResult shown = run({"export", ball(), "--format", format});
    EXPECT_EQ(shown.exit_code, 0) << shown.errors;
    const ProgramResult written = run(exporting(format));
    EXPECT_EQ(written.exit_code, 0) << written.errors;
    EXPECT_EQ(bytesOfFile("out.x"), shown.output);
    // Errors of MJCF are shown beside the file, too.
    EXPECT_EQ(written.output.empty(), format != "mjcf") << written.output;
  }
}

TEST_F(Export, OptionsReachTheFile) {
  const Arguments options{"--density", "1000", "--viscosity", "0", "--gravity",        "10",
                          "--mass",    "300",  "--up",        "y", "--forward",        "-x",
                          "--draught", "0.6",  "--speed",     "2", "--centre-of-mass", "0.1",
                          "0.2",       "0.3"};
  ASSERT_EQ(run(exporting("fossen", options)).exit_code, 0);
  const auto made = nlohmann::json::parse(bytesOfFile("out.x"));
  EXPECT_EQ(made["density"], 1000);
  EXPECT_EQ(made["gravity"], 10);
  EXPECT_EQ(made["mass"], 300);
  EXPECT_EQ(made["draught"], 0.6);
  EXPECT_EQ(made["speed"], 2);
  // Forward -x, to starboard forward times up = -z, down -y.
  EXPECT_EQ(made["centre_of_gravity"], nlohmann::json({-0.1, -0.3, -0.2}));
}

TEST_F(Export, BadOptionsAreRefusedInOneLine) {
  expectUsageRefusals("options of export", {"export", ball(), "-o", path("out.x")});
}

TEST_F(Export, BadInputIsRefusedInOneLine) {
  const std::size_t before = fileCount();
  EXPECT_EQ(refusal(exporting("sdf", {"--centre-of-mass", "0", "nan", "0"})),
            ball() +
                ": fluid body 'ball': distance of the centre of mass [m] is nan, must be "
                "finite");
  EXPECT_NE(refusal({"export", path("none.ambient"), "--format", "sdf"}).find("none.ambient"),
            std::string::npos);
  EXPECT_EQ(fileCount(), before) << "a file was left behind";
}

TEST_F(Export, PlacesThatCannotBeWrittenAreRefused) {
  const std::string nowhere = path("none/out.sdf");
  EXPECT_EQ(refusal({"export", ball(), "--format", "sdf", "-o", nowhere}),
            nowhere + ": the directory \"" + path("none") + "\" does not exist");
  EXPECT_EQ(refusal({"export", ball(), "--format", "sdf", "-o", folder_.path().string()}),
            folder_.path().string() + ": is a directory");
  EXPECT_EQ(refusal({"export", ball(), "--format", "sdf", "-o", ball()}),
            ball() + ": the output would replace the input");
  EXPECT_EQ(refusal({"export", ball(), "--format", "sdf", "-o", "/dev/full"}),
            "/dev/full: is not a regular file");
}

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
  EXPECT_EQ(inspect("500", "0.24").errors,
            "it floats with its z axis downwards in the likeliest attitude\n");
  EXPECT_EQ(inspect("500", "-0.24").errors, "");
  EXPECT_EQ(run({"inspect", file, "--mass", "500"}).errors, "") << "either side is up";
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

/// True if a text has a number that is not 0 and below 1e-9.
bool hasRounding(const std::string& text) {
  static const std::regex kTiny("e-(0[9]|[1-9][0-9]|[0-9]{3})");
  return std::regex_search(text, kTiny);
}

// A ball up to its middle in water: every turn is neutral.
TEST_F(FloatingCommand, InspectTellsHowABallFloats) {
  resultOf({"build", write("ball.json", sphereText()), "-o", path("ball.ambient"), "--json"});
  const Arguments inspect{"inspect",          path("ball.ambient"), "--mass",
                          "261.799387799149", "--density",          "1000"};
  const json ball = resultOf(appended(inspect, {"--json"}))["floating"];
  ASSERT_EQ(ball.size(), 1u);
  EXPECT_NEAR(ball[0]["draught"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(ball[0]["waterplane_area"].get<double>(), kPi / 4, 1e-9);
  EXPECT_NEAR(ball[0]["metacentres"][0]["height"].get<double>(), 0, 1e-9);
  int neutral = 0;
  for (const json& mode : ball[0]["modes"]) neutral += mode["period"].is_null() ? 1 : 0;
  EXPECT_EQ(neutral, 2);
  const std::string text = run(inspect).output;
  EXPECT_FALSE(hasRounding(text)) << text;
  EXPECT_NE(text.find("\n    heave         yes\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("\n    heave         no\n"), std::string::npos) << text;
}

TEST_F(FloatingCommand, InspectShowsNoRoundingInObliqueAxes) {
  const std::string box = write("box.json", R"({"type": "compound", "parts": [{
    "shape": {"type": "box", "size": [1, 0.5, 0.25]}, "orientation": [0.8, 0.2, -0.4, 0.4]}]})");
  resultOf({"build", box, "-o", path("box.ambient"), "--panels", "300", "--json"});
  const Arguments inspect{"inspect", path("box.ambient"), "--mass", "62.5", "--density", "1000"};
  EXPECT_TRUE(hasRounding(resultOf(appended(inspect, {"--json"})).dump()));
  const std::string text = run(inspect).output;
  EXPECT_FALSE(hasRounding(text)) << text;
  EXPECT_NE(text.find("height of mass  0 m"), std::string::npos) << text;
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

/// Wigley's hull of 50 x 12 x 3.5 m in quads, with straight sides and a deck above the water:
/// y = B/2 (1 - (2x/L)^2) (1 - (z/T)^2). Where keel and stem meet, port and starboard have three
/// corners in common, and quads of the deck have two.
std::string wigleyText() {
  constexpr int kAlong = 36, kUp = 12, kLevels = kUp + 2;
  std::ostringstream text;
  for (const int side : {-1, 1})
    for (int i = 0; i <= kAlong; ++i)
      for (int j = 0; j < kLevels; ++j) {
        const double s = 2.0 * i / kAlong - 1, t = std::min(double(j) / kUp - 1, 0.0);
        text << "v " << 25 * s << ' ' << side * 6 * (1 - s * s) * (1 - t * t) << ' '
             << (j > kUp ? 2 : 3.5 * t) << '\n';
      }
  const auto add = [&](int a, int b, int c, int d) {
    text << "f " << a << ' ' << b << ' ' << c << ' ' << d << '\n';
  };
  constexpr int kPort = (kAlong + 1) * kLevels;
  for (int i = 0; i < kAlong; ++i) {
    const int first = 1 + i * kLevels, next = first + kLevels;
    for (int j = 0; j <= kUp; ++j) {
      add(first + j, next + j, next + j + 1, first + j + 1);
      add(kPort + first + j, kPort + first + j + 1, kPort + next + j + 1, kPort + next + j);
    }
    const int deck = kLevels - 1;
    add(first + deck, next + deck, kPort + next + deck, kPort + first + deck);
  }
  return text.str();
}

// By the formulas GM is 3.964 m at 3.5 m; chords of the sides leave 0.4 % of the volume out.
TEST_F(FloatingCommand, WigleysHullOfQuadsFloatsAsItsFormulaSays) {
  const std::string file = path("wigley.ambient");
  const ProgramResult built = run({"build", write("wigley.obj", wigleyText()), "-o", file,
                                   "--origin", "0,0,0", "--panels", "0", "--strict"});
  ASSERT_EQ(built.exit_code, 0) << built.errors;
  EXPECT_NE(built.errors.find("opposite triangles on the same corners, were left out: 2"),
            std::string::npos)
      << built.errors;
  const json hull = upright(resultOf({"inspect", file, "--mass", "956667", "--density", "1025",
                                      "--centre-of-mass", "0", "0", "-1.75", "--json"}));
  EXPECT_NEAR(hull["draught"].get<double>(), 3.508, 0.001);
  EXPECT_NEAR(hull["metacentres"][0]["height"].get<double>(), 3.96, 0.005);
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
