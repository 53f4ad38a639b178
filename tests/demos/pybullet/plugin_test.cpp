// The plugin in the hands of a program that calls it in PyBullet's order.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/demos/pybullet/fake_server.h"
#include "tests/support/temporary_folder.h"

namespace ambient::pybullet::test {
namespace {

const char* const kPlugin = AMBIENT_PYBULLET_PLUGIN;
const char* const kWater = R"({"water": {"level": 0}})";

/// A command that is given a body, and more: `, "link": 0`.
std::string of(int body, const std::string& command, const std::string& more = "") {
  return "{\"" + command + "\": {\"body\": " + std::to_string(body) + more + "}}";
}

std::string restoring(int state) {
  return "{\"restore\": {\"state\": " + std::to_string(state) + "}}";
}

class PyBulletPlugin : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(server.load(kPlugin)); }
  void expectRefusal(const std::string& command, const char* part) {
    const std::string answer = server.command(command);
    EXPECT_EQ(answer.rfind("-1 ", 0), 0u) << command << ": " << answer;
    EXPECT_NE(answer.find(part), std::string::npos) << answer;
    EXPECT_EQ(answer.find('\n'), std::string::npos) << answer;
  }
  // K[3][3] of `inertia`.
  double massAlongX(int body) {
    const std::string answer = server.command(of(body, "inertia"));
    std::size_t at = 0;
    for (int row = -1; row < 4; ++row) at = answer.find('[', at + 1);
    for (int column = 0; column < 3; ++column) at = answer.find(',', at + 1);
    return std::stod(answer.substr(at + 1));
  }
  // The number that stands behind a key of the answer.
  double number(const std::string& command, const std::string& key) {
    const std::string answer = server.command(command);
    const std::size_t at = answer.find('"' + key + "\":");
    return at == std::string::npos ? NAN : std::stod(answer.substr(at + key.size() + 3));
  }
  // A number of a part of `wrench`: torque, then force.
  double wrench(int body, const std::string& part, int index) {
    const std::string answer = server.command(of(body, "wrench"));
    std::size_t at = answer.find('"' + part + "\":[");
    if (at == std::string::npos) return NAN;
    at += part.size() + 3;
    for (int i = 0; i < index; ++i) at = answer.find(',', at + 1);
    return std::stod(answer.substr(at + 1));
  }
  FakeServer server;
};

TEST_F(PyBulletPlugin, FloatsBodiesInWaterAloneAndGivesTheServerItsHelperBack) {
  EXPECT_FALSE(server.floats());
  EXPECT_EQ(server.command(kWater), "0 ");
  EXPECT_TRUE(server.floats());
  EXPECT_TRUE(server.hasItsHelper());
  EXPECT_EQ(server.command(R"({"remove": {}})"), "0 ");
  EXPECT_FALSE(server.floats());
}

TEST_F(PyBulletPlugin, IsBitwiseStockWithoutRegions) {
  FakeServer stock;
  const int other = stock.add(0.1, 4), body = server.add(0.1, 4);
  stock.step(100);
  server.step(100);
  EXPECT_EQ(server.height(body), stock.height(other));
}

TEST_F(PyBulletPlugin, SurvivesOtherTypesOfSolver) {
  server.command(kWater);
  EXPECT_TRUE(server.floats());
  for (const bool has_mlcp : {true, true, false}) {
    server.changeSolver(has_mlcp);
    EXPECT_TRUE(server.floats());
  }
  server.changeSolver(false);
  server.changeSolver(true);  // no step between
  EXPECT_TRUE(server.floats());
  server.changeSolver(false);
  server.reset();
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, SurvivesResets) {
  server.command(kWater);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(server.floats());
    server.reset();
  }
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, MakesAShapeOnceForAllClientsOfTheProcess) {
  const TemporaryFolder folder;
  const auto expectOneShape = [&](FakeServer& client) {
    EXPECT_EQ(client.command(R"({"settings": {"folder": ")" + folder.path().string() + R"("}})"),
              "0 ");
    EXPECT_EQ(client.command(kWater), "0 ");
    EXPECT_TRUE(client.floats());
    const std::string status = client.command(R"({"status": {}})");
    EXPECT_NE(status.find(R"("shapes":{"made":1,"read":0})"), std::string::npos) << status;
    client.reset();
  };
  expectOneShape(server);
  expectOneShape(server);
  FakeServer other;
  ASSERT_TRUE(other.load(kPlugin));
  expectOneShape(other);
  other.unload();
  server.unload();
  ASSERT_TRUE(server.load(kPlugin));
  expectOneShape(server);
}

// The first client makes the tray and is told of its hold once; the second one gets the same tray.
TEST_F(PyBulletPlugin, TellsWhatIsSaidOfABodyWhileItIsMade) {
  const TemporaryFolder folder;
  const auto expectHold = [&](FakeServer& client) {
    client.command(R"({"settings": {"folder": ")" + folder.path().string() + R"("}})");
    client.command(kWater);
    client.addTray(60);
    client.add(0.1, 4);
    client.step(1);
    client.addTray(70);
    client.step(1);
    const std::string status = client.command(R"({"status": {}})");
    std::size_t at = 0;  // of what is looked for, one after the other
    for (const char* part :
         {R"("said":["bullet_ambient: Compound: hold of 0.204)", R"("bodies":[{"body":0)",
          R"("said":["Compound: hold of 0.204)", R"("body":1)", R"("said":[]})", R"("body":2)",
          R"("said":["Compound: hold of 0.204)"}) {
      const std::size_t found = status.find(part, at);
      ASSERT_NE(found, std::string::npos) << part << " is not in " << status.substr(at);
      at = found + 1;
    }
    const std::string once = "bullet_ambient: Compound";
    EXPECT_EQ(status.find(once), status.rfind(once)) << status;
  };
  expectHold(server);
  server.reset();
  expectHold(server);
  FakeServer other;
  ASSERT_TRUE(other.load(kPlugin));
  expectHold(other);
}

// With several clients a step of one may come before the notification of another one's reset.
TEST_F(PyBulletPlugin, KnowsAResetBeforeItsNotification) {
  server.command(kWater);
  EXPECT_TRUE(server.floats());
  server.reset(true);
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, GivesABodyAtAnOldAddressItsOwnFluid) {
  server.command(R"({"region": {"density": 1000}})");
  for (int i = 0; i < 20; ++i) {
    const double half = 0.1 + 0.01 * (i % 7), mass = 1;
    const int body = server.add(half, mass);
    const double carried = (massAlongX(body) - mass) / (1000 * std::pow(2 * half, 3));
    EXPECT_NEAR(carried, 0.6, 0.1);  // that of a cube
    if (i % 3) server.step(1);
    server.remove(body);
  }
}

TEST_F(PyBulletPlugin, LeavesBodiesOut) {
  server.command(kWater);
  const int in = server.add(0.1, 4), out = server.add(0.1, 4), later = server.add(0.1, 4);
  EXPECT_EQ(server.command(of(out, "exclude")), "0 ");
  server.step(20);
  EXPECT_EQ(server.command(of(later, "exclude", R"(, "link": -1)")), "0 ");
  const double fall = server.body(later).getBaseVel().z();
  server.step(1);
  EXPECT_GT(server.height(in), -1);
  EXPECT_LT(server.height(out), -1);
  EXPECT_LT(server.body(later).getBaseVel().z(), fall);
  expectRefusal(R"({"exclude": {}})", "key \"body\" is missing in exclude");
  server.reset();  // numbers begin anew
  EXPECT_TRUE(server.floats());
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, GivesABodyTheFluidBodyThatIsChosen) {
  server.command(R"({"water": {"level": 0, "density": 1000}})");
  const int body = server.add(0.1, 4);
  EXPECT_NEAR(number(of(body, "wet"), "volume"), 0.008, 1e-6);
  EXPECT_EQ(server.command(of(body, "body", R"(, "link": -1, "density": 2000, "drag": [1, 1, 2])")),
            "0 ");
  EXPECT_NEAR(number(of(body, "wet"), "volume"), 0.002, 1e-6);
  EXPECT_EQ(server.command(of(body, "exclude")), "0 ");
  EXPECT_EQ(server.command(of(body, "body", R"(, "density": 400)")), "0 ");  // in the fluid again
  EXPECT_NEAR(number(of(body, "wet"), "volume"), 0.01, 1e-6);
  EXPECT_NEAR(number(R"({"status": {}})", "volume"), 0.01, 1e-9);
  EXPECT_NEAR(number(R"({"status": {}})", "density"), 400, 1e-6);
  server.step(1);
  expectRefusal(of(body, "body", R"(, "density": 0)"), "must be > 0");
  EXPECT_NE(server.command(of(body, "body", R"(, "file": "none.ambient")")).find("-1 none.ambient"),
            std::string::npos);
  EXPECT_NE(
      server.command(of(body, "body", R"(, "link": 3)")).find("there is no body 0 with link 3"),
      std::string::npos);
}

// 1/2 rho v^2 A C_D of what the density leaves: a cube of 0.1 m. Without viscosity, as friction
// comes on top.
TEST_F(PyBulletPlugin, TakesTheDragThatWasMeasured) {
  server.command(R"({"region": {"density": 1.2, "viscosity": 0, "velocity": [10, 0, 0]}})");
  const int body = server.add(0.1, 4);
  for (const double drag : {0.7, 1.4}) {
    const std::string coefficients = "[" + std::to_string(drag) + ", 1, 1]";
    EXPECT_EQ(server.command(of(body, "body", R"(, "density": 4000, "drag": )" + coefficients)),
              "0 ");
    const double expected = 0.5 * 1.2 * 100 * 0.01 * drag;
    EXPECT_NEAR(wrench(body, "pressure", 3), expected, 1e-6 * expected);  // measured 1.5e-7
    EXPECT_EQ(wrench(body, "friction", 3), 0);
  }
}

// A new world may have other settings.
TEST_F(PyBulletPlugin, TakesOtherSettingsAfterAReset) {
  server.command(kWater);
  EXPECT_TRUE(server.floats());
  server.reset();
  EXPECT_EQ(server.command(R"({"settings": {"law": "published"}})"), "0 ");
  EXPECT_TRUE(server.floats());
  expectRefusal(R"({"settings": {"law": "form"}})", "too late");
}

TEST_F(PyBulletPlugin, RestoresItsStates) {
  server.command(kWater);
  const int body = server.add(0.1, 4);
  server.step(20);
  EXPECT_EQ(server.command(R"({"save": {}})"), "0 0");
  server.step(20);
  const double end = server.height(body);
  EXPECT_EQ(server.command(restoring(0)), "0 ");
  server.step(20);
  EXPECT_EQ(server.height(body), end);
  EXPECT_EQ(server.command(restoring(1)).rfind("-1 ", 0), 0u);
  server.reset();
  EXPECT_EQ(server.command(restoring(0)).rfind("-1 ", 0), 0u);
}

// One cube comes to lie on the other one.
TEST_F(PyBulletPlugin, SaysOnceThatASavedStateDoesNotGoOnBitForBit) {
  server.command(kWater);
  const auto expectSaid = [&](const std::string& answer) {
    EXPECT_EQ(server.command(R"({"save": {}})").rfind("0 ", 0), 0u);
    const std::string said = server.command(R"({"status": {}})"), key = "OverlappingPairs=1";
    EXPECT_EQ(said.find(key) == std::string::npos, answer == "no") << said;
    EXPECT_EQ(said.find(key), said.rfind(key)) << said;
  };
  const int lower = server.add(0.1, 4), upper = server.add(0.1, 4);
  server.step(1);
  expectSaid("no");
  server.body(upper).setBasePos(server.body(lower).getBasePos() + btVector3(0, 0, btScalar(0.19)));
  server.world().getDispatchInfo().m_deterministicOverlappingPairs = true;
  server.step(2);
  expectSaid("no");
  server.world().getDispatchInfo().m_deterministicOverlappingPairs = false;
  expectSaid("once");
  expectSaid("once");
}

TEST_F(PyBulletPlugin, TellsWhatIsWetAndWhatTheFluidDoes) {
  server.command(R"({"water": {"level": -1, "density": 1000}})");
  const int body = server.add(0.1, 4);  // its centre at the surface
  EXPECT_NEAR(number(of(body, "wet"), "volume"), 0.004, 1e-6);
  EXPECT_NEAR(number(of(body, "wet"), "share"), 0.5, 1e-3);
  EXPECT_NEAR(number(of(body, "wet"), "draught"), 0.1, 1e-6);
  EXPECT_NEAR(wrench(body, "buoyancy", 5), 1000 * 9.81 * 0.004, 0.4);
}

TEST_F(PyBulletPlugin, GoesOffAndOn) {
  for (int i = 0; i < 2; ++i) {
    server.command(kWater);
    EXPECT_TRUE(server.floats());
    EXPECT_EQ(server.command(R"({"off": {}})"), "0 ");
    EXPECT_FALSE(server.floats());
  }
}

TEST_F(PyBulletPlugin, CanBeUnloaded) {
  server.command(kWater);
  EXPECT_TRUE(server.floats());
  server.changeSolver(true);
  server.unload();
  EXPECT_FALSE(server.floats());
}

TEST_F(PyBulletPlugin, MayBeUnloadedAfterItsWorld) {
  FakeServer other;
  ASSERT_TRUE(other.load(kPlugin));
  other.command(kWater);
  EXPECT_TRUE(other.floats());
}

TEST_F(PyBulletPlugin, TakesTextsLongerThanPyBulletDoes) {
  std::string waves = R"({"water": {"level": 0, "waves": [)";
  for (int i = 0; i < 200; ++i)
    waves +=
        (i > 0 ? "," : "") + std::string(R"({"amplitude": 0.0001, "period": 2, "phase": 0.5})");
  expectRefusal(waves, "empty");
  for (std::size_t at = 0; at < waves.size(); at += 1000)
    EXPECT_EQ(server.command("+" + waves.substr(at, 1000)), "0 ");
  EXPECT_EQ(server.command(R"(], "density": 1000}})"), "0 ");
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, PushesBodiesByThrustersAsMuchInStepsOfSubsteps) {
  server.command(R"({"region": {"density": 1000, "viscosity": 0}})");
  server.world().setGravity({0, 0, 0});
  const int cube = server.add(0.5, 1000);
  const std::string screw = R"({"equip": {"thrusters": [{"name": "screw", "on": ")" +
                            std::to_string(cube) + R"(", "curve": [[-1, -40], [1, 40]]}]}})";
  server.body(cube).setLinearDamping(0);
  ASSERT_EQ(server.command(screw), "0 ");
  ASSERT_EQ(server.command(R"({"drive": {"screw": 0.5}})"), "0 ");
  const double mass = massAlongX(cube);
  EXPECT_GT(mass, 1500);
  double speed = 0;
  // Drag of 1/2 rho A v^2 is 1e-9 of the thrust.
  for (const int substeps : {1, 4}) {
    server.world().stepSimulation(0.01, substeps, 0.01 / substeps);
    speed += 20 * 0.01 / mass;
    EXPECT_NEAR(server.body(cube).getBaseVel().x(), speed, 1e-6 * speed) << substeps;
  }
  EXPECT_NEAR(number(R"({"drives": {}})", "thrust"), 20, 1e-12);
  EXPECT_EQ(server.command(of(cube, "exclude")), "0 ");
  EXPECT_EQ(server.command(R"({"drives": {}})"), "0 {\"thrusters\":{},\"foils\":{}}");
}

TEST_F(PyBulletPlugin, TurnsFoilsAndKeepsTheirAnglesInSavedStates) {
  server.command(R"({"region": {"density": 1000, "viscosity": 0}})");
  server.world().setGravity({0, 0, 0});
  const int cube = server.add(0.5, 1000);
  const auto foil = [&](const std::string& name, const std::string& more) {
    return server.command(R"({"equip": {"foils": [{"name": ")" + name + R"(", "on": ")" +
                          std::to_string(cube) + R"(", "span": 2, "chord": 0.2, )" + more + "}]}}");
  };
  const std::string turns = R"("curve": [[-1, 0.5], [1, -0.5]], "lag": 0.05)";
  ASSERT_EQ(foil("rudder", R"("span_axis": [0, 0, 1], "position": [-1, 0, 0], )" + turns), "0 ");
  EXPECT_EQ(foil("plane", R"("aspect": 5)"), "0 ") << "beside the first";
  server.command(R"({"drive": {"rudder": 1}})");
  server.step(48);
  const double angle = number(R"({"drives": {}})", "angle");
  EXPECT_NEAR(angle, -0.5, 0.02) << "after four times its lag";
  EXPECT_EQ(server.command(R"({"save": {}})"), "0 0");
  server.command(R"({"drive": {"rudder": -1}})");
  server.step(48);
  EXPECT_GT(number(R"({"drives": {}})", "angle"), 0.4);
  server.command(restoring(0));
  EXPECT_EQ(number(R"({"drives": {}})", "angle"), angle);
  // With its leading edge to the right it pushes the stern there.
  server.body(cube).setBaseVel({2, 0, 0});
  server.command(R"({"drive": {"rudder": 1}})");
  server.step(10);
  EXPECT_GT(server.body(cube).getBaseOmega().z(), 1e-3);
  expectRefusal(of(cube, "body", R"(, "density": 500)"), "body: it has foils; choose it before");
  expectRefusal(R"({"drive": {"ruder": 1}})", "drive: there is no foil or thruster \"ruder\"");
  expectRefusal(R"({"equip": {"foils": [{"on": "77", "span": 1, "chord": 1}]}})",
                "body 77, link -1 is not in the fluid");
  expectRefusal(R"({"equip": {"foils": [{"on": "boat", "span": 1, "chord": 1}]}})",
                "equip: on is \"boat\"; must be numbers of a body, or of body/link");
  server.remove(cube);
  server.step(1);
  EXPECT_EQ(server.command(R"({"drives": {}})"), "0 {\"thrusters\":{},\"foils\":{}}");
}

TEST_F(PyBulletPlugin, RefusesInOneLineWhatItDoesNotUnderstand) {
  expectRefusal(R"({"nonsense": {}})",
                "unknown key \"nonsense\" in the command, which has air, body");
  expectRefusal(R"({"water": {"level": 0, "levle": 0}})", "unknown key \"levle\" in water");
  expectRefusal("water level=0", "is not valid JSON");
  expectRefusal("{}", "must have one name, not 0");
  expectRefusal(R"({"save": {}, "off": {}})", "must have one name, not 2");
  expectRefusal(R"({"water": {"level": "x"}})", "water.level is \"x\"; must be of type");
  expectRefusal(R"({"water": {"level": 1e999}})", "is not valid JSON");
  expectRefusal(R"({"water": {"level": 0, "current": [1, 2]}})", "at least 3 values");
  expectRefusal(R"({"water": {"level": 0, "density": -1}})", "density");
  expectRefusal(R"({"water": {"level": 0, "up": [0, 0, 0]}})", "water: ");
  expectRefusal(R"({"water": {"level": 0, "waves": [{"amplitude": -1, "period": 2}]}})",
                "amplitude");
  expectRefusal(
      R"({"water": {"level": 0, "spectrum": {"significant_height": 1, "peak_period": 5, "components": 1.5}}})",
      "integer");
  expectRefusal(R"({"settings": {"law": "any"}})", "settings.law is \"any\"; must be one of");
  expectRefusal(R"({"settings": {"quality": "instant"}})",
                "unknown key \"quality\" in settings, which has folder, law, roughness, "
                "separation");
  expectRefusal(R"({"inertia": {}})", "key \"body\" is missing");
  expectRefusal(R"({"remove": {"name": "pool"}})", "there is no such region");
  server.command(kWater);
  EXPECT_TRUE(server.floats());
  expectRefusal(R"({"settings": {"law": "published"}})", "too late");
}

TEST_F(PyBulletPlugin, RefusesSettingsThatNoBodyCanHave) {
  expectRefusal(R"({"settings": {"separation": 1}})",
                "settings: separation angle [rad] is 1; must be between pi/2 and pi");
  EXPECT_EQ(server.command(R"({"settings": {"roughness": 100}})"), "0 ");  // there are no bodies
  const int body = server.add(0.1, 4);
  expectRefusal(kWater, "roughness [m] is 100, must be from 0 to 0.489");
  EXPECT_EQ(server.command(R"({"settings": {"roughness": 0}})"), "0 ");
  for (const char* rough : {"100", "1e300"})
    expectRefusal(R"({"settings": {"roughness": )" + std::string(rough) + "}}",
                  "settings: body 'PyBullet 0");
  expectRefusal(R"({"settings": {"roughness": 1}})", "must be from 0 to 0.489");
  EXPECT_EQ(server.command(R"({"settings": {"roughness": 1e-3}})"), "0 ");
  server.command(kWater);
  EXPECT_TRUE(server.floats());
  expectRefusal(R"({"body": {"body": )" + std::to_string(body) + R"(, "roughness": 1}})",
                "roughness [m] is 1, must be from 0 to 0.489");
  EXPECT_TRUE(server.floats()) << "a refusal takes nothing out of the fluid";
  EXPECT_GT(massAlongX(body), 4.1);
  EXPECT_EQ(
      server.command(R"({"body": {"body": )" + std::to_string(body) + R"(, "roughness": 0.01}})"),
      "0 ");
}

TEST_F(PyBulletPlugin, SaysThatTheDefaultLawDoesNotReadAnAngle) {
  const std::string angle = R"({"settings": {"separation": 2}})", status = R"({"status": {}})";
  EXPECT_EQ(server.command(angle), "0 ");
  server.command(kWater);
  server.add(0.1, 4);
  server.step(1);
  const std::string said = server.command(status);
  EXPECT_NE(said.find("a separation angle, which the form law does not read"), std::string::npos)
      << said;
}

// PyBullets before 3.1.7 have a smaller btMultiBody: here members hold what none of ours does.
TEST_F(PyBulletPlugin, RefusesOtherLayouts) {
  server.command(kWater);
  const int body = server.add(0.1, 4);
  server.body(body).setMaxAppliedImpulse(1);
  server.step(60);
  EXPECT_LT(server.height(body), -1);
  expectRefusal(R"({"save": {}})", "3.1.7 and later");
  server.reset();
  server.world().getSolverInfo().m_maxErrorReduction = 1;
  EXPECT_FALSE(server.floats());
  expectRefusal(R"({"save": {}})", "3.1.7 and later");
}

TEST_F(PyBulletPlugin, RefusesAWorldWhereAnotherCopyIs) {
  FakeServer other;
  ASSERT_TRUE(other.load(kPlugin));
  other.command(kWater);
  EXPECT_TRUE(other.floats());
  btConstraintSolver* solver = server.world().getConstraintSolver();
  server.world().setMultiBodyConstraintSolver(
      static_cast<btMultiBodyConstraintSolver*>(other.world().getConstraintSolver()));
  expectRefusal(R"({"save": {}})", "another copy of this plugin");
  server.world().setMultiBodyConstraintSolver(static_cast<btMultiBodyConstraintSolver*>(solver));
}

TEST_F(PyBulletPlugin, TellsItsStatus) {
  server.command(kWater);
  server.command(
      R"({"air": {"name": "wind", "bounds": {"lowest": [0, 0, 0], "highest": [1, 1, 1]}, "wind": [3, 0, 0]}})");
  EXPECT_TRUE(server.floats());
  const std::string status = server.command(R"({"status": {}})");
  EXPECT_NE(status.find(R"("regions":["water","wind"])"), std::string::npos) << status;
  EXPECT_NE(status.find(R"("members":1)"), std::string::npos) << status;
}

}  // namespace
}  // namespace ambient::pybullet::test
