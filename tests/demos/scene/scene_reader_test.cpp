#include "demos/scene/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/plain_text.h"
#include "demos/integrators/integrators.h"
#include "tests/demos/scene/scene_text.h"

namespace ambient {
namespace {

using nlohmann::json;

Scene readText(const json& scene) {
  const TemporaryFolder folder;
  return readScene(writeScene(folder, scene.dump()));
}

std::string complaintAboutText(const std::string& text) {
  const TemporaryFolder folder;
  try {
    readScene(writeScene(folder, text));
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// Returns the complaint after one change to the scene, e.g. {"bodies", 0, "mass"} := -1.
std::string complaintAfter(const char* pointer, const json& value) {
  json scene = ballScene();
  scene[json::json_pointer(pointer)] = value;
  return complaintAbout(scene);
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
  text["integrator"] = {{"method", "rk4"}, {"tolerance", 1e-4}, {"max_substeps", 7}};
  const Scene scene = readText(text);

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
  const Scene scene = readText(json::parse(R"({"duration": 1, "time_step": 0.1, "bodies": [
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

TEST(SceneReader, NamesAnUnknownKeyAndItsPlace) {
  EXPECT_EQ(complaintAfter("/gravitation", 1).find("unknown key \"gravitation\" in the scene, "),
            0u);
  EXPECT_EQ(complaintAfter("/medium/temperature", 20),
            "unknown key \"temperature\" in medium, which has acceleration, density, velocity, "
            "viscosity");
  EXPECT_EQ(complaintAfter("/bodies/0/masss", 1).find("unknown key \"masss\" in bodies[0], "), 0u);
  EXPECT_EQ(complaintAfter("/bodies/0/shape/side", 1),
            "unknown key \"side\" in bodies[0].shape, which has faces, radius, type");
}

TEST(SceneReader, NamesAMissingKeyAndItsPlace) {
  json scene = ballScene();
  scene.erase("duration");
  EXPECT_EQ(complaintAbout(scene), "key \"duration\" is missing in the scene");
  scene = ballScene();
  scene["bodies"][0].erase("mass");
  EXPECT_EQ(complaintAbout(scene), "key \"mass\" is missing in bodies[0]");
}

TEST(SceneReader, RejectsAWrongTypeOrLength) {
  EXPECT_EQ(complaintAfter("/time_step", "fast"),
            "time_step is \"fast\"; must be of type \"number\"");
  EXPECT_EQ(complaintAfter("/gravity", json::parse("[0, 0]")),
            "gravity is [0,0]; must be at least 3 values");
  EXPECT_EQ(complaintAfter("/bodies/0/position/1", true),
            "bodies[0].position[1] is true; must be of type \"number\"");
}

TEST(SceneReader, RejectsIntegersThatNoIntHolds) {
  const std::int64_t wrapped = (std::int64_t{1} << 32) + 1;
  EXPECT_NE(complaintAfter("/integrator", {{"max_substeps", wrapped}})
                .find("integrator.max_substeps is 4294967297; must be <= 1000000"),
            std::string::npos);
  EXPECT_NE(complaintAfter("/threads", wrapped).find("threads is 4294967297; must be <= 256"),
            std::string::npos);
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
    const json schema = json::parse(ambient::readText(file));
    EXPECT_EQ(unboundedIntegers(schema, name), "");
  }
}

TEST(SceneReader, TellsTheNameOfEveryIntegrator) {
  for (const char* const name : {"leapfrog", "dormand_prince", "rk4", "symplectic_euler"}) {
    json scene = ballScene();
    scene["integrator"] = {{"method", name}};
    EXPECT_STREQ(wordOf(kIntegratorNames, readText(scene).flight.own_flight), name);
  }
}

TEST(SceneReader, RejectsErrorsOfLoadsThatCannotBe) {
  EXPECT_EQ(complaintAfter("/bodies/0/maximum_load_error", -0.01),
            "bodies[0].maximum_load_error is -0.01; must be >= 0");
  EXPECT_EQ(complaintAfter("/bodies/0/maximum_load_error", 1.01),
            "bodies[0].maximum_load_error is 1.01; must be <= 1");
}

TEST(SceneReader, RejectsAnUnknownModel) {
  EXPECT_EQ(complaintAfter("/model", "navier-stokes"),
            "model is \"navier-stokes\"; must be one of "
            "[\"ambient\",\"ideal\",\"vacuum\",\"uwrbd\",\"gwtf\"]");
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
  const Scene scene = readText(jointScene());
  ASSERT_EQ(scene.joints.size(), 2u);
  EXPECT_EQ(scene.joints[0].bodies, std::vector<std::string>{"ball"});
  EXPECT_EQ(scene.joints[0].point, Vector3(0, 0, 2));
  EXPECT_FALSE(scene.joints[0].axis);
  EXPECT_EQ(scene.joints[1].bodies, (std::vector<std::string>{"wall", "ball"}));
  EXPECT_EQ(*scene.joints[1].axis, Vector3(0, 2, 0));
}

TEST(SceneReader, RejectsJointsThatJoinNothing) {
  const auto complaint = [](const char* place, const json& value) {
    json scene = jointScene();
    scene[json::json_pointer(std::string("/joints/1") + place)] = value;
    return complaintAbout(scene);
  };
  EXPECT_EQ(complaint("/bodies/1", "bal"),
            "joints[1].bodies names \"bal\", which no body is called");
  EXPECT_EQ(complaint("/bodies", json::parse(R"(["wall"])")),
            "joints[1].bodies are all static; one must have a mass > 0");
  EXPECT_EQ(complaint("/bodies/0", "ball"), "joints[1].bodies names \"ball\" twice");
  EXPECT_EQ(complaint("/axis", {0, 0, 0}), "joints[1].axis is 0, 0, 0; must have a length > 0");
  EXPECT_EQ(complaint("/type", "hinge"),
            "unknown key \"type\" in joints[1], which has axis, bodies, point");
}

TEST(SceneReader, RejectsTimesThatCannotBeStepped) {
  EXPECT_EQ(complaintAfter("/duration", 0), "duration is 0; must be > 0");
  EXPECT_EQ(complaintAfter("/time_step", 0), "time_step is 0; must be > 0");
  EXPECT_EQ(complaintAfter("/time_step", -0.01), "time_step is -0.01; must be > 0");
  EXPECT_EQ(complaintAfter("/output_step", -1), "output_step is -1; must be > 0");
  EXPECT_EQ(complaintAfter("/output_step", 0.005),
            "output_step is 0.005; must be >= time_step (0.01 s)");
  EXPECT_EQ(complaintAfter("/time_step", 3), "time_step is 3; must be <= duration (2 s)");
  EXPECT_EQ(complaintAfter("/time_step", 1e-10),
            "duration / time_step is 20000000000; must be <= 1e9 steps");
}

TEST(SceneReader, RejectsANegativeFluid) {
  EXPECT_EQ(complaintAfter("/medium/density", -1), "medium.density is -1; must be >= 0");
  EXPECT_EQ(complaintAfter("/medium/viscosity", -1), "medium.viscosity is -1; must be >= 0");
  EXPECT_EQ(complaintAfter("/bodies/0/fluid_density", -2),
            "bodies[0].fluid_density is -2; must be >= 0");
}

TEST(SceneReader, RejectsAQuaternionThatIsNotUnit) {
  EXPECT_EQ(complaintAfter("/bodies/0/orientation", {1, 0, 0, 1}),
            "bodies[0] (ball) orientation has norm 1.41421356237; must be 1 within 1e-06");
  EXPECT_EQ(complaintAfter("/bodies/0/orientation", {0, 0, 0, 0}),
            "bodies[0] (ball) orientation has norm 0; must be 1 within 1e-06");
}

TEST(SceneReader, TakesRoundingOutOfAQuaternion) {
  json scene = ballScene();
  scene["bodies"][0]["orientation"] = {0.707107, 0, 0.707107, 0};
  EXPECT_NEAR(readText(scene).bodies[0].orientation.norm(), 1, 2e-16);
}

TEST(SceneReader, RejectsAStaticBodyThatMoves) {
  json scene = ballScene();
  scene["bodies"][0]["mass"] = 0;
  EXPECT_EQ(complaintAbout(scene),
            "bodies[0] (ball) mass is 0, a static body, but linear_velocity is 30 m/s; must be 0");
  scene["bodies"][0]["linear_velocity"] = {0, 0, 0};
  EXPECT_EQ(
      complaintAbout(scene),
      "bodies[0] (ball) mass is 0, a static body, but angular_velocity is 60 rad/s; must be 0");
  scene["bodies"][0]["angular_velocity"] = {0, 0, 0};
  EXPECT_EQ(complaintAbout(scene), "");
}

TEST(SceneReader, TakesAWaterlineTableOfABodyThatMoves) {
  json text = ballScene();
  text["bodies"][0]["waterline_table"] = 4;
  EXPECT_EQ(sceneFrom(text).bodies[0].waterline_table, 4);
  text["bodies"][0]["mass"] = 0;
  text["bodies"][0].erase("linear_velocity");
  text["bodies"][0].erase("angular_velocity");
  EXPECT_EQ(complaintAbout(text),
            "bodies[0] (ball) mass is 0, a static body, but waterline_table is 4; must be 0");
}

TEST(SceneReader, RejectsANegativeMass) {
  EXPECT_EQ(complaintAfter("/bodies/0/mass", -0.1), "bodies[0].mass is -0.1; must be >= 0");
}

TEST(SceneReader, RejectsAnInertiaThatNoBodyHas) {
  EXPECT_EQ(complaintAfter("/bodies/0/inertia", {1, 1, -1, 0, 0, 0}),
            "bodies[0] (ball) inertia has the principal moments -1, 1, 1 kg m^2; all must be > 0");
  EXPECT_EQ(complaintAfter("/bodies/0/inertia", {1, 1, 1, 2, 0, 0}),
            "bodies[0] (ball) inertia has the principal moments -1, 1, 3 kg m^2; all must be > 0");
  EXPECT_EQ(complaintAfter("/bodies/0/inertia", {1, 1, 2.5, 0, 0, 0}),
            "bodies[0] (ball) inertia has the principal moments 1, 1, 2.5 kg m^2; none may exceed "
            "the sum of the other two");
}

TEST(SceneReader, AcceptsTheInertiaOfAThinDisc) {
  EXPECT_EQ(complaintAfter("/bodies/0/inertia", {1, 1, 2, 0, 0, 0}), "");
}

TEST(SceneReader, RejectsASeparationAngleOutsideItsRange) {
  EXPECT_EQ(complaintAfter("/bodies/0/separation_angle", 1.5),
            "bodies[0] (ball) separation_angle is 1.5; must be from pi/2 to pi");
  EXPECT_EQ(complaintAfter("/bodies/0/separation_angle", 3.2),
            "bodies[0] (ball) separation_angle is 3.2; must be from pi/2 to pi");
}

TEST(SceneReader, TakesPrintedDigitsOfARightAngleForOne) {
  json scene = ballScene();
  scene["bodies"][0]["separation_angle"] = 1.570796;
  EXPECT_EQ(readText(scene).bodies[0].attach.flow.separation_angle, 1.5707963267948966);
}

TEST(SceneReader, RejectsTwoBodiesOfOneName) {
  json scene = ballScene();
  scene["bodies"].push_back(scene["bodies"][0]);
  EXPECT_EQ(complaintAbout(scene), "bodies[1].name \"ball\" is used twice");
}

TEST(SceneReader, RejectsANameThatWouldBreakTheCsvFile) {
  EXPECT_EQ(complaintAfter("/bodies/0/name", "a,b"),
            "bodies[0].name contains a comma, a quote or a line break");
}

TEST(SceneReader, RejectsAKeyGivenTwice) {
  const std::string complaint = complaintAboutText(R"({"duration": 1, "duration": 2})");
  EXPECT_NE(complaint.find("key \"duration\" is given twice"), std::string::npos) << complaint;
}

TEST(SceneReader, SaysWhereTheJsonIsBroken) {
  const std::string complaint = complaintAboutText("{\n \"duration\": 1,\n \"time_step\": }");
  EXPECT_NE(complaint.find("is not valid JSON: parse error at line 3, column 15"),
            std::string::npos)
      << complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
}

TEST(SceneReader, RejectsANumberTooLargeForADouble) {
  const std::string complaint = complaintAboutText(R"({"duration": 1e999})");
  EXPECT_NE(complaint.find("1e999"), std::string::npos) << complaint;
}

TEST(SceneReader, NamesAMissingFile) {
  EXPECT_THROW(
      try { readScene("no/such/scene.json"); } catch (const std::exception& error) {
        EXPECT_STREQ(error.what(), "no/such/scene.json: no such file");
        throw;
      },
      std::exception);
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
  scene["bodies"][0]["law"] = "newton";
  EXPECT_NE(complaintAbout(scene).find("bodies[0].law"), std::string::npos)
      << complaintAbout(scene);
}

}  // namespace
}  // namespace ambient
