#include "demos/scene/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "bullet_ambient/force/medium/waves.h"
#include "bullet_ambient/wind.h"
#include "demos/integrators/integrators.h"
#include "demos/scene/scene_water.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/support/refusal_of.h"
#include "tests/support/refusals.h"

namespace ambient {
namespace {

// Expects what a group of refusals.json says of changes to a scene.
void expectSceneRefusals(const std::string& group, const nlohmann::json& scene) {
  expectRefusals(AMBIENT_SCENE_REFUSALS, group, [&scene](const nlohmann::json& changes) {
    return complaintAbout(withChanges(scene, changes));
  });
}

using nlohmann::json;

std::string complaintAboutText(const std::string& text) {
  const TemporaryFolder folder;
  return test::refusalOf<std::exception>([&] { readScene(writeScene(folder, text)); });
}

TEST(SceneReader, TakesEveryValueOver) {
  json text = ballScene();
  json& body = text["bodies"][0];
  body["inertia"] = {0.03, 0.04, 0.05, 0.001, 0.002, 0.003};
  body["mass_distribution"] = "surface";
  body["centre_of_mass"] = {0.01, 0.02, 0.03};
  body["orientation"] = {0.5, -0.5, 0.5, 0.5};
  body["separation_angle"] = 2.0;
  body["skin_friction"] = false;
  body["maximum_load_error"] = 0.02;
  body["fluid_density"] = 998;
  body["wave_damping"] = 0.5;
  body["added_mass_factor"] = 0.8;
  body["load_factor"] = 1.3;
  text["integrator"] = {{"method", "rk4"}, {"tolerance", 1e-4}, {"max_substeps", 7}};
  const Scene scene = sceneFrom(text);

  EXPECT_EQ(scene.name, "ball");
  EXPECT_EQ(scene.duration, 2);
  EXPECT_EQ(scene.time_step, 0.01);
  EXPECT_EQ(scene.output_step, 0.05);
  EXPECT_EQ(scene.gravity, Vector3(0, 0, -9.81));
  EXPECT_EQ(scene.medium.density, 1.204);
  EXPECT_EQ(scene.medium.viscosity, 1.82e-5);
  EXPECT_EQ(scene.flight.own_flight, flyRungeKutta);
  EXPECT_EQ(scene.flight.tolerance, 1e-4);
  EXPECT_EQ(scene.flight.max_substeps, 7);
  ASSERT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.bodies[0].attach.wave_damping, 0.5);
  EXPECT_EQ(scene.bodies[0].attach.added_mass_factor, 0.8);
  EXPECT_EQ(scene.bodies[0].attach.load_factor, 1.3);
  const BodyDef& ball = scene.bodies[0];
  EXPECT_EQ(ball.name, "ball");
  EXPECT_EQ(ball.mass, 0.43);
  EXPECT_EQ(ball.mass_kind, MassKind::kSurface);
  Matrix3 inertia;
  inertia << 0.03, 0.001, 0.002, 0.001, 0.04, 0.003, 0.002, 0.003, 0.05;
  EXPECT_EQ(*ball.inertia, inertia);
  EXPECT_EQ(*ball.centre_of_mass, Vector3(0.01, 0.02, 0.03));
  EXPECT_EQ(ball.orientation.coeffs(), Quaternion(0.5, -0.5, 0.5, 0.5).coeffs());
  EXPECT_EQ(ball.linear_velocity, Vector3(30, 0, 0));
  EXPECT_EQ(ball.angular_velocity, Vector3(0, 0, 60));
  EXPECT_EQ(ball.attach.flow.separation_angle, 2.0);
  EXPECT_FALSE(ball.attach.flow.skin_friction);
  EXPECT_EQ(ball.attach.flow.maximum_load_error, 0.02);
  EXPECT_EQ(ball.attach.medium.density, 998);
}

TEST(SceneReader, FillsInWhatMayBeLeftOut) {
  const Scene scene = sceneFrom(json::parse(R"({"duration": 1, "time_step": 0.1, "bodies": [
      {"shape": {"type": "sphere", "radius": 1}, "mass": 1}]})"));
  EXPECT_EQ(scene.output_step, 0.1);
  EXPECT_EQ(scene.gravity, Vector3(0, 0, -9.81));
  EXPECT_EQ(scene.medium.density, air().density);
  EXPECT_EQ(scene.model, FluidModel::kAmbient);
  EXPECT_EQ(scene.bodies[0].name, "body_0");
  EXPECT_EQ(scene.bodies[0].attach.flow.separation_angle, std::acos(-1.0) / 2);
  EXPECT_TRUE(scene.bodies[0].attach.flow.skin_friction);
  EXPECT_EQ(scene.bodies[0].attach.flow.maximum_load_error, FlowSettings{}.maximum_load_error);
  EXPECT_FALSE(scene.bodies[0].inertia);
}

/// Lists the places of integers without bounds in a schema.
std::string unboundedIntegers(const json& schema, const std::string& place) {
  std::string found;
  if (schema.is_object() && schema.value("type", json()) == "integer" &&
      !(schema.contains("minimum") && schema.contains("maximum")))
    found = place + " ";
  if (schema.is_structured())
    for (const auto& [key, part] : schema.items())
      found += unboundedIntegers(part, place + "/" + key);
  return found;
}

TEST(SceneReader, EveryIntegerHasBounds) {
  for (const char* const name : {"scene", "shape"}) {
    const std::string file = std::string(AMBIENT_SCHEMAS) + "/" + name + ".schema.json";
    const json schema = json::parse(readText(file));
    EXPECT_EQ(unboundedIntegers(schema, name), "");
  }
}

/// A ball on a joint to the world, and a static ball.
json jointScene() {
  json scene = ballScene();
  scene["bodies"].push_back(
      {{"name", "wall"}, {"shape", {{"type", "sphere"}, {"radius", 1}}}, {"mass", 0}});
  scene["joints"] = json::parse(R"([{"bodies": ["ball"], "point": [0, 0, 2]},
      {"bodies": ["wall", "ball"], "point": [1, 2, 3], "axis": [0, 2, 0]}])");
  return scene;
}

TEST(SceneReader, ReadsJoints) {
  const Scene scene = sceneFrom(jointScene());
  ASSERT_EQ(scene.joints.size(), 2u);
  EXPECT_EQ(scene.joints[0].bodies, std::vector<std::string>{"ball"});
  EXPECT_EQ(scene.joints[0].point, Vector3(0, 0, 2));
  EXPECT_FALSE(scene.joints[0].axis);
  EXPECT_EQ(scene.joints[1].bodies, (std::vector<std::string>{"wall", "ball"}));
  EXPECT_EQ(*scene.joints[1].axis, Vector3(0, 2, 0));
}

TEST(SceneReader, TakesRoundingOutOfAQuaternion) {
  json scene = ballScene();
  scene["bodies"][0]["orientation"] = {0.707107, 0, 0.707107, 0};
  EXPECT_NEAR(sceneFrom(scene).bodies[0].orientation.norm(), 1, 2e-16);
}

TEST(SceneReader, TakesAWaterlineTableOfABodyThatMoves) {
  json text = ballScene();
  text["bodies"][0]["waterline_table"] = 4;
  EXPECT_EQ(sceneFrom(text).bodies[0].waterline_table, 4);
}

TEST(SceneReader, TakesPrintedDigitsOfARightAngleForOne) {
  json scene = ballScene();
  scene["bodies"][0]["separation_angle"] = 1.570796;
  EXPECT_EQ(sceneFrom(scene).bodies[0].attach.flow.separation_angle, 1.5707963267948966);
}

TEST(SceneReader, RejectsWhatCannotBe) {
  expectSceneRefusals("ball", ballScene());
  expectSceneRefusals("joints", jointScene());
  expectRefusals(AMBIENT_SCENE_REFUSALS, "texts", complaintAboutText);
}

TEST(SceneReader, ReadsThrusters) {
  json text = ballScene();
  text["thrusters"] = json::array({{{"on", "ball"},
                                    {"position", {0, 0.1, 0}},
                                    {"axis", {0, 3, 4}},
                                    {"curve", {{-1, -20}, {0, 0}, {0.5, 4}, {1, 30}}},
                                    {"lag", 0.2},
                                    {"radius", 0.03},
                                    {"torque_per_thrust", 0.01}}});
  const Scene scene = sceneFrom(text);
  const ThrusterDef& thruster = scene.thrusters.at(0);
  EXPECT_EQ(thruster.name, "thruster_0");
  EXPECT_EQ(thruster.body, 0u);
  EXPECT_EQ(thruster.position, Vector3(0, 0.1, 0));
  EXPECT_NEAR((thruster.axis - Vector3(0, 0.6, 0.8)).norm(), 0, 1e-15);
  EXPECT_EQ(thruster.lag, 0.2);
  EXPECT_EQ(thruster.radius, 0.03);
  EXPECT_EQ(thruster.torque_per_thrust, 0.01);
  const double thrusts[][2] = {{-3, -20},  {-0.5, -10}, {0, 0}, {0.25, 2},
                               {0.75, 17}, {1, 30},     {2, 30}};
  for (const auto& [command, thrust] : thrusts) EXPECT_EQ(valueAt(thruster.curve, command), thrust);
}

TEST(SceneReader, ReadsPropellers) {
  json text = ballScene();
  json thruster = {{"on", "ball"}, {"curve", {{0, 0}, {1, 20}}}};
  text["thrusters"] = json::array({thruster, thruster, thruster});
  text["thrusters"][0]["propeller"] = {{"diameter", 0.3}};
  text["thrusters"][1]["propeller"] = {
      {"diameter", 0.2}, {"ct_cp", {{0, 0.1, 0.05}, {0.8, 0, 0.02}}}, {"hand", "left"}};
  text["thrusters"][2]["propeller"] = {
      {"diameter", 0.4},
      {"wageningen", {{"blades", 5}, {"area_ratio", 0.6}, {"pitch_ratio", 0.8}}}};
  const std::vector<ThrusterDef> read = sceneFrom(text).thrusters;
  EXPECT_TRUE(read.at(0).propeller->isIdealDisc());
  EXPECT_EQ(read.at(0).radius, 0.15);
  // C_P = 2 pi K_Q: the power is rho n^3 D^5 C_P.
  EXPECT_NEAR(read.at(1).propeller->load(10, 0, 1.2).power, 1.2 * 1e3 * 3.2e-4 * 0.05, 1e-15);
  EXPECT_TRUE(read.at(1).is_left_handed);
  const Propeller screw = Propeller::wageningen(0.4, {5, 0.6, 0.8});
  EXPECT_EQ(read.at(2).propeller->load(3, 1, 998).torque, screw.load(3, 1, 998).torque);
  EXPECT_FALSE(read.at(2).is_left_handed);
}

// Three propellers of the UIUC Propeller Database: what was measured comes back.
TEST(SceneReader, ReadsMeasuredPropellers) {
  std::ifstream file(std::string(AMBIENT_SCHEMAS) + "/../reality/propellers.json");
  const json measured = json::parse(file).at("propellers");
  ASSERT_EQ(measured.size(), 3u);
  for (const json& of : measured) {
    json text = ballScene();
    json thruster = {{"on", "ball"}, {"curve", {{0, 0}, {1, 100}}}};
    thruster["propeller"] = {{"diameter", of.at("diameter")}, {"ct_cp", of.at("ct_cp")}};
    text["thrusters"] = json::array({thruster});
    const Propeller propeller = *sceneFrom(text).thrusters.at(0).propeller;
    const double n = of.at("turns").get<double>(), d = propeller.diameter();
    const double scale = 1.2 * n * n * std::pow(d, 4);
    for (const json& row : of.at("ct_cp")) {
      const PropellerLoad load = propeller.load(n, row[0].get<double>() * n * d, 1.2);
      EXPECT_NEAR(load.thrust / scale, row[1].get<double>(), 1e-14) << of.at("name") << row;
      EXPECT_NEAR(load.power / (scale * n * d), row[2].get<double>(), 1e-14);
    }
  }
}

TEST(SceneReader, ReadsFoils) {
  json text = ballScene();
  text["foils"] = json::array(
      {{{"on", "ball"},
        {"position", {1, 2, 3}},
        {"chord_axis", {0, 1, 0}},
        {"span_axis", {0, 0, 1}},
        {"span", 2},
        {"chord", 0.5},
        {"thickness", 0.05},
        {"camber", 0.02},
        {"drag", 0.008},
        {"aspect", 8},
        {"curve", {{-1, -0.6}, {1, 0.6}}},
        {"command", 0.5},
        {"lag", 0.3}},
       {{"on", "ball"}, {"span", 1}, {"chord", 1}, {"polar", {{0, 0, 0.1}, {3.141593, 0, 0.2}}}}});
  const std::vector<FoilDef> foils = sceneFrom(text).foils;
  const Foil& foil = foils.at(0).foil;
  EXPECT_EQ(foils[0].name, "foil_0");
  EXPECT_EQ(foil.position, Vector3(1, 2, 3));
  EXPECT_EQ(foil.chord_axis, Vector3(0, 1, 0));
  EXPECT_EQ(foil.span_axis, Vector3(0, 0, 1));
  const double numbers[] = {foil.span, foil.chord,  foil.thickness,   foil.camber,
                            foil.drag, foil.aspect, foils[0].command, foils[0].lag};
  const double expected[] = {2, 0.5, 0.05, 0.02, 0.008, 8, 0.5, 0.3};
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_EQ(numbers[i], expected[i]);
  EXPECT_NEAR(valueAt(foils[0].curve, 0.5), 0.3, 1e-15);
  EXPECT_EQ(foils.at(1).foil.polar.at(1).drag, 0.2);
}

TEST(SceneReader, NamesAMissingFile) {
  EXPECT_EQ(test::refusalOf<std::exception>([] { readScene("no/such/scene.json"); }),
            "no/such/scene.json: no such file");
}

// The schema names them too, for editors.
TEST(SceneReader, KnowsEveryIntegratorAndLaw) {
  nlohmann::json scene = ballScene();
  for (const auto& [integrator, name] : kIntegratorNames) {
    scene["integrator"]["method"] = name;
    EXPECT_EQ(sceneFrom(scene).flight.own_flight, integrator);
  }
  for (const auto& [law, name] : kPressureLawNames) {
    scene["law"] = scene["bodies"][0]["law"] = name;
    EXPECT_EQ(sceneFrom(scene).law, law);
    EXPECT_EQ(sceneFrom(scene).bodies[0].attach.flow.law, law);
  }
}

TEST(SceneReader, TakesTheLawOfTheSceneUnlessABodyNamesItsOwn) {
  nlohmann::json scene = ballScene();
  EXPECT_EQ(sceneFrom(scene).bodies[0].attach.flow.law, PressureLaw::kForm);
  scene["law"] = "published";
  EXPECT_EQ(sceneFrom(scene).bodies[0].attach.flow.law, PressureLaw::kPublished);
  scene["bodies"][0]["law"] = "form";
  scene["bodies"][0]["stall_lag"] = 0;
  EXPECT_EQ(sceneFrom(scene).bodies[0].attach.flow.law, PressureLaw::kForm);
  EXPECT_EQ(sceneFrom(scene).bodies[0].attach.flow.stall_lag, 0);
}

Scene readWith(const std::vector<SceneOverride>& overrides) {
  const TemporaryFolder folder;
  return readScene(writeScene(folder, ballScene().dump()), overrides);
}

TEST(SceneOverride, SetsAPlaceInEitherSpelling) {
  EXPECT_EQ(readWith({{"bodies.0.mass", "0.001"}}).bodies[0].mass, 0.001);
  EXPECT_EQ(readWith({{"bodies[0].mass", "1e-3"}}).bodies[0].mass, 0.001);
  EXPECT_EQ(readWith({{"bodies[0].position[2]", "7"}}).bodies[0].position, Vector3(0, 0, 7));
  EXPECT_EQ(readWith({{"medium.density", "0"}}).medium.density, 0);
}

TEST(SceneOverride, TakesAVectorAsJsonAndAWordAsString) {
  EXPECT_EQ(readWith({{"gravity", "[1, 2, 3]"}}).gravity, Vector3(1, 2, 3));
  EXPECT_EQ(readWith({{"model", "vacuum"}}).model, FluidModel::kVacuum);
  EXPECT_EQ(readWith({{"model", "\"vacuum\""}}).model, FluidModel::kVacuum);
}

TEST(SceneOverride, MakesWhatIsOnTheWayToAKnownKey) {
  EXPECT_EQ(readWith({{"integrator.method", "rk4"}}).flight.own_flight, flyRungeKutta);
}

TEST(SceneOverride, TheLastOneWins) {
  EXPECT_EQ(readWith({{"duration", "3"}, {"duration", "4"}}).duration, 4);
}

TEST(SceneOverride, RejectsAPathThatTheSchemaDoesNotKnow) {
  // The keys are those that a wrong key in a file is told of.
  nlohmann::json wrong = ballScene();
  wrong["bodies"][0]["weight"] = 1;
  EXPECT_EQ(complaintAbout(ballScene(), {{"bodies.0.weight", "1"}}), complaintAbout(wrong, {}));
}

TEST(SceneOverride, RejectsWhatCannotBe) {
  expectRefusals(AMBIENT_SCENE_REFUSALS, "overrides", [](const json& set) {
    const SceneOverride change{set.begin().key(), set.begin().value().get<std::string>()};
    return complaintAbout(ballScene(), {change});
  });
}

TEST(SceneOverride, RejectsTextThatIsNotUtf8) {
  EXPECT_EQ(complaintAbout(ballScene(), {{"model", "\xcf"}}),
            "--set model: the value is not valid UTF-8");
  EXPECT_EQ(complaintAbout(ballScene(), {{"bodies.0.ma\xedss", "2"}}),
            "--set: the path is not valid UTF-8");
}

TEST(SceneOverride, SplitsAtTheFirstEqualsSign) {
  const SceneOverride parsed = parseOverride("description=a=b");
  EXPECT_EQ(parsed.path, "description");
  EXPECT_EQ(parsed.value, "a=b");
}

TEST(SceneOverride, NeedsAPathAndAnEqualsSign) {
  EXPECT_THROW(parseOverride("duration"), std::invalid_argument);
  EXPECT_THROW(parseOverride("=3"), std::invalid_argument);
}

TEST(SceneLookup, FindsANameInTheFirstFolderThatHasIt) {
  const TemporaryFolder first, second;
  writeScene(first, "{}", "a.json");
  writeScene(second, "{}", "a.json");
  writeScene(second, "{}", "b.json");
  const std::vector<std::filesystem::path> folders{first.path(), second.path()};
  EXPECT_EQ(findScene("a", folders), first / "a.json");
  EXPECT_EQ(findScene("b", folders), second / "b.json");
  EXPECT_EQ(listScenes(folders).size(), 2u);
}

TEST(SceneLookup, TakesAPathAsItIs) {
  EXPECT_EQ(findScene("x/y", {}), "x/y");
  EXPECT_EQ(findScene("y.json", {}), "y.json");
}

TEST(SceneLookup, ListsTheKnownNamesWhenOneIsNot) {
  const TemporaryFolder folder;
  writeScene(folder, "{}", "a.json");
  writeScene(folder, "{}", "b.json");
  EXPECT_EQ(test::refusalOf<std::exception>([&] { findScene("c", {folder.path()}); }),
            "scene \"c\" is not known; known are: a, b; or give the path of a .json file");
}

json seaScene() {
  json scene = ballScene();
  scene["gravity"] = {0, -4, 0};
  scene["water"] = json::parse(R"({"level": 0.5, "current": [1, 0, 0], "density": 1025,
    "waves": [{"amplitude": 0.1, "period": 2}, {"amplitude": 0, "period": 3, "direction": [0, 0, 1], "phase": 1}],
    "bounds": {"lowest": [null, -2, -3], "highest": [4, null, 5]}})");
  scene["regions"] =
      json::parse(R"([{"medium": {"density": 2, "velocity": [3, 0, 0]}, "priority": 4,
    "bounds": {"lowest": [0, 0, 0], "highest": [1, 1, 1]}}, {"medium": {"density": 7}}])");
  return scene;
}

TEST(SceneWater, TakesWaterOver) {
  const Scene scene = sceneFrom(seaScene());
  ASSERT_TRUE(scene.water);
  EXPECT_EQ(scene.water->sea.level, 0.5);
  EXPECT_EQ(scene.water->sea.up, Vector3(0, 4, 0));
  EXPECT_EQ(scene.water->sea.gravity, 4);
  EXPECT_EQ(scene.water->sea.current, Vector3(1, 0, 0));
  EXPECT_EQ(scene.water->medium.density, 1025);
  EXPECT_EQ(scene.water->medium.viscosity, water().viscosity);
  ASSERT_EQ(scene.water->waves.size(), 2u);
  EXPECT_EQ(scene.water->waves[0].amplitude, 0.1);
  EXPECT_EQ(scene.water->waves[0].direction, Vector3(1, 0, 0));
  EXPECT_EQ(scene.water->waves[1].direction, Vector3(0, 0, 1));
  EXPECT_EQ(scene.water->waves[1].phase, 1);
  ASSERT_TRUE(scene.water->bounds);
  EXPECT_EQ(scene.water->bounds->lowest, Vector3(-HUGE_VAL, -2, -3));
  EXPECT_EQ(scene.water->bounds->highest, Vector3(4, HUGE_VAL, 5));
}

TEST(SceneWater, MakesRegionsOfWaterFirst) {
  json text = seaScene();
  const std::vector<FluidRegion> regions = makeRegions(sceneFrom(text));
  ASSERT_EQ(regions.size(), 3u);
  EXPECT_EQ(regions[0].below.density, 1025);
  EXPECT_EQ(regions[0].above.value().density, 1.204);
  EXPECT_FALSE(regions[0].surface->isStill());
  // Deep water has the current of the waves, added once.
  EXPECT_NEAR(sampleRegion(regions[0], {0, -40, 0}, 0).here().velocity.x(), 1, 1e-12);
  EXPECT_EQ(regions[1].below.velocity.x(), 3);
  EXPECT_EQ(regions[1].priority, 4);
  EXPECT_TRUE(regions[1].bounds->hold({0.5, 0.5, 0.5}));
  EXPECT_FALSE(regions[2].bounds);
  text["water"].erase("waves");
  const FluidRegion still = makeRegions(sceneFrom(text))[0];
  EXPECT_TRUE(still.surface->isStill());
  EXPECT_EQ(sampleRegion(still, {0, 0, 0}, 0).here().velocity, Vector3(1, 0, 0));
  EXPECT_TRUE(sampleRegion(still, {0, 0.6, 0}, 0).isAbove());
}

// All flows and layers as C++ makes them, with the scene's up: y.
TEST(SceneWater, TakesFlowsAndLayers) {
  json text = seaScene();
  text["water"]["flow"] = json::parse(R"([
    {"current_profile": {"levels": [[0, 1, 0, 0], [2, 0, 0, 0]], "surface": 0.5}},
    {"discrete_gust": {"velocity": [0, 0, 2], "start": 1, "rise": 2, "hold": null}}])");
  text["water"]["flow_above"] = json::parse(R"([
    {"wind_profile": {"velocity": [9, 0, 0], "height": 5, "roughness": 0, "exponent": 0.5, "ground": 0.5}}])");
  text["water"]["layers"] = {{"levels", {{-3, 1030}, {-1, 1020}}}};
  text["regions"][0]["flow"] = json::parse(R"([
    {"turbulence": {"length": 3, "intensity": 0.5, "smallest": 1, "carried": [1, 0, 0], "seed": 5},
     "dryden_gusts": {"height": 20, "speed": 7, "intensity": 2, "direction": [1, 0, 1], "seed": 6},
     "gauss_markov_gusts": {"intensity": [1, 0, 2], "time": 3, "seed": 7}}])");
  text["regions"][0]["layers"] = {{"standard_atmosphere", {0, 500}}};
  const std::vector<FluidRegion> regions = makeRegions(sceneFrom(text));
  EXPECT_EQ(regions[0].flow({0, -0.5, 0}, 9).velocity, Vector3(0.5, 0, 2));
  EXPECT_NEAR(regions[0].flow_above({0, 1.75, 0}, 0).velocity.x(), 4.5, 1e-12);
  EXPECT_EQ(regions[0].layers->density(-2), 1025);
  EXPECT_EQ(regions[0].layers->up(), Vector3(0, 1, 0));
  Turbulence eddies{3, 0.5, 1, {1, 0, 0}, 5};
  const DrydenGusts gusts{20, 7, 2, {1, 0, 1}, {0, 1, 0}, 6};
  EXPECT_EQ(
      regions[1].flow({1, 2, 3}, 4).velocity,
      (drydenGusts(gusts) + gaussMarkovGusts({{1, 0, 2}, 3, 7}) + turbulence(eddies))({1, 2, 3}, 4)
          .velocity);
  EXPECT_EQ(regions[1].layers->density(0), standardAtmosphere(0).density);
  EXPECT_FALSE(regions[2].flow || regions[2].layers);
}

TEST(SceneWater, AddsTheWavesOfASpectrum) {
  json text = seaScene();
  text["water"]["spectrum"] = json::parse(R"({"significant_height": 0.2, "peak_period": 3,
    "peak_enhancement": 1, "direction": [0, 0, 2], "components": 7, "seed": 5})");
  const std::vector<WaveComponent> waves = sceneFrom(text).water->waves;
  ASSERT_EQ(waves.size(), 9u);
  WaveSpectrum spectrum{0.2, 3, 1, {0, 0, 2}, 7, 5};
  const std::vector<WaveComponent> expected = wavesOf(spectrum);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(waves[i].amplitude, expected[i].amplitude);
    EXPECT_EQ(waves[i].period, expected[i].period);
    EXPECT_EQ(waves[i].direction, expected[i].direction);
    EXPECT_EQ(waves[i].phase, expected[i].phase);
  }
  EXPECT_EQ(waves[7].amplitude, 0.1);
  text["water"]["spectrum"] = {{"significant_height", 1}, {"peak_period", 8}};
  EXPECT_EQ(sceneFrom(text).water->waves[0].phase, wavesOf({1, 8})[0].phase);
}

TEST(SceneWater, SaysWhatIsWrongWithWaterAndRegions) { expectSceneRefusals("water", seaScene()); }

}  // namespace
}  // namespace ambient
