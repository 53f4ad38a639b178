// The plugin in the hands of a program that calls it in PyBullet's order.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/demos/pybullet/fake_server.h"
#include "tests/support/temporary_folder.h"

namespace ambient::pybullet::test {
namespace {

const char* const kPlugin = AMBIENT_PYBULLET_PLUGIN;

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
    const std::string answer = server.command("inertia", {body});
    std::size_t at = 0;
    for (int row = -1; row < 4; ++row) at = answer.find('[', at + 1);
    for (int column = 0; column < 3; ++column) at = answer.find(',', at + 1);
    return std::stod(answer.substr(at + 1));
  }
  // The number that stands behind a key of the answer.
  double number(const std::string& command, int body, const std::string& key) {
    const std::string answer = server.command(command, {body});
    const std::size_t at = answer.find('"' + key + "\":");
    return at == std::string::npos ? NAN : std::stod(answer.substr(at + key.size() + 3));
  }
  FakeServer server;
};

TEST_F(PyBulletPlugin, FloatsBodiesInWaterAloneAndGivesTheServerItsHelperBack) {
  EXPECT_FALSE(server.floats());
  EXPECT_EQ(server.command("water level=0"), "0 ");
  EXPECT_TRUE(server.floats());
  EXPECT_TRUE(server.hasItsHelper());
  EXPECT_EQ(server.command("remove"), "0 ");
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
  server.command("water level=0");
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
  server.command("water level=0");
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(server.floats());
    server.reset();
  }
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, MakesAShapeOnceForAllClientsOfTheProcess) {
  const TemporaryFolder folder;
  const auto expectOneShape = [&](FakeServer& client) {
    EXPECT_EQ(client.command("settings folder=" + folder.path().string()), "0 ");
    EXPECT_EQ(client.command("water level=0"), "0 ");
    EXPECT_TRUE(client.floats());
    const std::string status = client.command("status");
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

// With several clients a step of one may come before the notification of another one's reset.
TEST_F(PyBulletPlugin, KnowsAResetBeforeItsNotification) {
  server.command("water level=0");
  EXPECT_TRUE(server.floats());
  server.reset(true);
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, GivesABodyAtAnOldAddressItsOwnFluid) {
  server.command("region density=1000");
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
  server.command("water level=0");
  const int in = server.add(0.1, 4), out = server.add(0.1, 4), later = server.add(0.1, 4);
  EXPECT_EQ(server.command("exclude", {out}), "0 ");
  server.step(20);
  EXPECT_EQ(server.command("exclude", {later, -1}), "0 ");
  const double fall = server.body(later).getBaseVel().z();
  server.step(1);
  EXPECT_GT(server.height(in), -1);
  EXPECT_LT(server.height(out), -1);
  EXPECT_LT(server.body(later).getBaseVel().z(), fall);
  expectRefusal("exclude", "takes the number of a body");
  server.reset();  // numbers begin anew
  EXPECT_TRUE(server.floats());
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, GivesABodyTheFluidBodyThatIsChosen) {
  server.command("water level=0 density=1000");
  const int body = server.add(0.1, 4);
  EXPECT_NEAR(number("wet", body, "volume"), 0.008, 1e-6);
  EXPECT_EQ(server.command("body density=2000 drag=1,1,2", {body, -1}), "0 ");
  EXPECT_NEAR(number("wet", body, "volume"), 0.002, 1e-6);
  EXPECT_EQ(server.command("exclude", {body}), "0 ");
  EXPECT_EQ(server.command("body density=400", {body}), "0 ");  // in the fluid again
  EXPECT_NEAR(number("wet", body, "volume"), 0.01, 1e-6);
  EXPECT_NEAR(number("status", body, "volume"), 0.01, 1e-9);
  EXPECT_NEAR(number("status", body, "density"), 400, 1e-6);
  server.step(1);
  expectRefusal("body density=0", "must be > 0");
  EXPECT_NE(server.command("body file=none.ambient", {body}).find("-1 none.ambient"),
            std::string::npos);
  EXPECT_NE(server.command("body", {body, 3}).find("there is no body 0 with link 3"),
            std::string::npos);
}

// A new world may have other settings.
TEST_F(PyBulletPlugin, TakesOtherSettingsAfterAReset) {
  server.command("water level=0");
  EXPECT_TRUE(server.floats());
  server.reset();
  EXPECT_EQ(server.command("settings law=published"), "0 ");
  EXPECT_TRUE(server.floats());
  expectRefusal("settings law=form", "too late");
}

TEST_F(PyBulletPlugin, RestoresItsStates) {
  server.command("water level=0");
  const int body = server.add(0.1, 4);
  server.step(20);
  EXPECT_EQ(server.command("save"), "0 0");
  server.step(20);
  const double end = server.height(body);
  EXPECT_EQ(server.command("restore", {0}), "0 ");
  server.step(20);
  EXPECT_EQ(server.height(body), end);
  EXPECT_EQ(server.command("restore", {1}).rfind("-1 ", 0), 0u);
  server.reset();
  EXPECT_EQ(server.command("restore", {0}).rfind("-1 ", 0), 0u);
}

TEST_F(PyBulletPlugin, TellsWhatIsWetAndWhatTheFluidDoes) {
  server.command("water level=-1 density=1000");
  const int body = server.add(0.1, 4);  // its centre at the surface
  EXPECT_NEAR(number("wet", body, "volume"), 0.004, 1e-6);
  EXPECT_NEAR(number("wet", body, "share"), 0.5, 1e-3);
  EXPECT_NEAR(number("wet", body, "draught"), 0.1, 1e-6);
  const std::string parts = server.command("wrench", {body});
  const std::size_t buoyancy = parts.find("\"buoyancy\":[");
  ASSERT_NE(buoyancy, std::string::npos) << parts;
  std::size_t at = buoyancy;
  for (int i = 0; i < 5; ++i) at = parts.find(',', at + 1);
  EXPECT_NEAR(std::stod(parts.substr(at + 1)), 1000 * 9.81 * 0.004, 0.4);
}

TEST_F(PyBulletPlugin, GoesOffAndOn) {
  for (int i = 0; i < 2; ++i) {
    server.command("water level=0");
    EXPECT_TRUE(server.floats());
    EXPECT_EQ(server.command("off"), "0 ");
    EXPECT_FALSE(server.floats());
  }
}

TEST_F(PyBulletPlugin, CanBeUnloaded) {
  server.command("water level=0");
  EXPECT_TRUE(server.floats());
  server.changeSolver(true);
  server.unload();
  EXPECT_FALSE(server.floats());
}

TEST_F(PyBulletPlugin, MayBeUnloadedAfterItsWorld) {
  FakeServer other;
  ASSERT_TRUE(other.load(kPlugin));
  other.command("water level=0");
  EXPECT_TRUE(other.floats());
}

TEST_F(PyBulletPlugin, TakesTextsLongerThanPyBulletDoes) {
  const std::string wave = "0.0001,2,1,0,0,0.5;";
  std::string waves = "water level=0 waves=";
  for (int i = 0; i < 200; ++i) waves += wave;
  expectRefusal(waves, "empty");
  for (std::size_t at = 0; at < waves.size(); at += 1000)
    EXPECT_EQ(server.command("+" + waves.substr(at, 1000)), "0 ");
  EXPECT_EQ(server.command(" density=1000"), "0 ");
  EXPECT_TRUE(server.floats());
}

TEST_F(PyBulletPlugin, RefusesInOneLineWhatItDoesNotUnderstand) {
  expectRefusal("nonsense", "there are: water");
  expectRefusal("water levle=0", "there is no 'levle'");
  expectRefusal("water level", "is not key=value");
  expectRefusal("water level=x", "'x' is not a finite number");
  expectRefusal("water current=1,2", "takes 3 numbers, not 2");
  expectRefusal("water density=-1", "density");
  expectRefusal("water waves=-1,2", "amplitude");
  expectRefusal("water spectrum=1,5,1,0,0,3.3,1.5", "whole numbers");
  expectRefusal("settings law=any", "law is one of:");
  expectRefusal("settings quality=instant",
                "there is no 'quality'; there are: folder law separation");
  expectRefusal("inertia", "takes the number of a body");
  expectRefusal("remove name=pool", "there is no such region");
  server.command("water level=0");
  EXPECT_TRUE(server.floats());
  expectRefusal("settings law=published", "too late");
}

// PyBullets before 3.1.7 have a smaller btMultiBody: here members hold what none of ours does.
TEST_F(PyBulletPlugin, RefusesOtherLayouts) {
  server.command("water level=0");
  const int body = server.add(0.1, 4);
  server.body(body).setMaxAppliedImpulse(1);
  server.step(60);
  EXPECT_LT(server.height(body), -1);
  expectRefusal("save", "3.1.7 and later");
  server.reset();
  server.world().getSolverInfo().m_maxErrorReduction = 1;
  EXPECT_FALSE(server.floats());
  expectRefusal("save", "3.1.7 and later");
}

TEST_F(PyBulletPlugin, RefusesAWorldWhereAnotherCopyIs) {
  FakeServer other;
  ASSERT_TRUE(other.load(kPlugin));
  other.command("water level=0");
  EXPECT_TRUE(other.floats());
  btConstraintSolver* solver = server.world().getConstraintSolver();
  server.world().setMultiBodyConstraintSolver(
      static_cast<btMultiBodyConstraintSolver*>(other.world().getConstraintSolver()));
  expectRefusal("save", "another copy of this plugin");
  server.world().setMultiBodyConstraintSolver(static_cast<btMultiBodyConstraintSolver*>(solver));
}

TEST_F(PyBulletPlugin, TellsItsStatus) {
  server.command("water level=0");
  server.command("air name=wind bounds=0,0,0,1,1,1 wind=3,0,0");
  EXPECT_TRUE(server.floats());
  const std::string status = server.command("status");
  EXPECT_NE(status.find(R"("regions":["water","wind"])"), std::string::npos) << status;
  EXPECT_NE(status.find(R"("members":1)"), std::string::npos) << status;
}

}  // namespace
}  // namespace ambient::pybullet::test
