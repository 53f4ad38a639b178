#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/world.h"

namespace ambient {
namespace {

using nlohmann::json;

void writeWorld(btDiscreteDynamicsWorld& world, btSerializer& serializer,
                const std::filesystem::path& file) {
  world.serialize(&serializer);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(serializer.getBufferPointer()),
             serializer.getCurrentBufferSize());
}

/// A Bullet world, filled and saved without steps.
class SavedWorld {
 public:
  void add(btCollisionShape& shape, double mass, const char* name) {
    const btRigidBody& body =
        host_.contents.add(mass, {1, 1, 1}, shape, btTransform::getIdentity());
    if (name != nullptr) serializer_.registerNameForPointer(&body, name);
  }

  void name(const btCollisionShape& shape, const char* name) {
    serializer_.registerNameForPointer(&shape, name);
  }

  void save(const std::filesystem::path& file) { writeWorld(host_.world, serializer_, file); }

 private:
  test::WholeWorld<> host_;
  btDefaultSerializer serializer_;
};

class WorldBuild : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static ProgramResult run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "build");
    return runProgram(AMBIENT_PREPROCESS, arguments);
  }

  ProgramResult build(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{path("w.bullet"), "-o",  path("out"),
                                       "--panels",       "500", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  static json shapeOf(const ProgramResult& result, const std::string& name) {
    const json report = json::parse(result.output);
    for (const json& shape : report["shapes"]) {
      if (shape["name"] == name) return shape;
    }
    return {};
  }

  TemporaryFolder folder_;
};

void saveGoodWorld(const std::string& file) {
  btBoxShape crate(btVector3(btScalar(0.5), btScalar(0.25), 1));
  btSphereShape ball(btScalar(0.5));
  btCapsuleShape pill(btScalar(0.25), 1);
  btStaticPlaneShape ground(btVector3(0, 1, 0), 0);
  SavedWorld world;
  world.add(ground, 0, "ground");
  world.add(crate, 2, "crate 1");
  world.add(crate, 3, "crate 2");
  world.name(crate, "crate");
  world.add(ball, 1, "../ball");
  world.add(pill, 1, nullptr);
  world.save(file);
}

TEST_F(WorldBuild, EveryShapeOfADynamicBodyGetsItsFile) {
  saveGoodWorld(path("w.bullet"));
  const ProgramResult result = build();
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  ASSERT_EQ(json::parse(result.output)["shapes"].size(), 3u) << result.output;
  EXPECT_EQ(shapeOf(result, "crate")["bodies"], json({"crate 1", "crate 2"}));
  EXPECT_EQ(shapeOf(result, "crate")["status"], "built");
  // The importer passes shapes in single precision.
  EXPECT_NEAR(shapeOf(result, "crate")["size"][1].get<double>(), 0.5, 1e-6);
  EXPECT_NEAR(shapeOf(result, "crate")["size"][2].get<double>(), 2, 1e-6);
  EXPECT_NEAR(readFluidBody(path("out/crate.ambient")).volume, 1, 1e-6);
  const FluidBody ball = readFluidBody(path("out/_._ball.ambient"));
  EXPECT_NEAR(ball.volume, std::acos(-1.0) / 6, 1e-12);
  EXPECT_NEAR(ball.added_mass(4, 4), ball.volume / 2, 1e-12);
  EXPECT_TRUE(std::filesystem::exists(path("out/body_4.ambient"))) << result.output;
}

TEST_F(WorldBuild, FilesAreKeptUntilSomethingChanges) {
  saveGoodWorld(path("w.bullet"));
  const auto statusOf = [&](const ProgramResult& result, const char* name) {
    return shapeOf(result, name)["status"].get<std::string>();
  };
  build();
  const auto time = std::filesystem::last_write_time(path("out/crate.ambient"));
  const ProgramResult again = build();
  EXPECT_EQ(statusOf(again, "crate"), "kept");
  EXPECT_EQ(std::filesystem::last_write_time(path("out/crate.ambient")), time);
  EXPECT_EQ(statusOf(build({"--rebuild"}), "crate"), "built");
  std::ofstream(path("out/_._ball.ambient")) << "damaged";
  btBoxShape crate(btVector3(btScalar(0.5), btScalar(0.25), btScalar(1.01)));
  btSphereShape ball(btScalar(0.5));
  {
    SavedWorld other;
    other.add(crate, 2, "crate");
    other.add(ball, 1, "../ball");
    other.save(path("w.bullet"));
  }
  const ProgramResult changed = build();
  EXPECT_EQ(statusOf(changed, "crate"), "built");
  EXPECT_EQ(statusOf(changed, "_._ball"), "built");
  EXPECT_NEAR(readFluidBody(path("out/crate.ambient")).volume, 1.01, 1e-6);
}

TEST_F(WorldBuild, MultibodiesAreLeftOutWithASentence) {
  test::TreeWorld host;
  btMultiBody& pendulum = host.contents.take(
      std::make_unique<btMultiBody>(1, btScalar(1), btVector3(1, 1, 1), true, false));
  pendulum.setupRevolute(0, 1, btVector3(1, 1, 1), -1, btQuaternion::getIdentity(),
                         btVector3(0, 1, 0), btVector3(0, 0, 0), btVector3(0, 0, -1));
  pendulum.finalizeMultiDof();
  btDefaultSerializer serializer;
  writeWorld(host.world, serializer, path("w.bullet"));
  const ProgramResult result = build();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.errors, path("w.bullet") +
                               ": 1 multibodies were left out: makeFluidBody makes the fluid "
                               "bodies of their links\n");
  EXPECT_EQ(json::parse(result.output)["lost_multibodies"], 1);
}

TEST_F(WorldBuild, OneBadShapeDoesNotStopTheOthers) {
  btBoxShape box(btVector3(1, 1, 1));
  btCompoundShape nothing;
  {
    SavedWorld world;
    world.add(nothing, 1, "clump");
    world.add(box, 1, "box");
    world.save(path("w.bullet"));
  }
  const ProgramResult result = build();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.errors.find(path("w.bullet") + ": clump: a compound shape without children"), 0u)
      << result.errors;
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1);
  EXPECT_EQ(shapeOf(result, "clump")["status"], "failed");
  EXPECT_EQ(shapeOf(result, "box")["status"], "built");
  EXPECT_FALSE(std::filesystem::exists(path("out/clump.ambient")));
}

TEST_F(WorldBuild, MarginsDisplaceNothingAndNobodyIsToldOfThem) {
  btConeShape cone(btScalar(0.1), btScalar(0.2));
  cone.setMargin(btScalar(0.04));
  {
    SavedWorld world;
    world.add(cone, 1, "cone");
    world.save(path("w.bullet"));
  }
  const ProgramResult result = build();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.errors, "");
  EXPECT_NEAR(shapeOf(result, "cone")["volume"].get<double>(), kPi * 0.1 * 0.1 * 0.2 / 3, 1e-8);
}

TEST_F(WorldBuild, TellsEachShapeOnce) {
  saveGoodWorld(path("w.bullet"));
  const ProgramResult result = run({path("w.bullet"), "-o", path("out"), "--panels", "0"});
  EXPECT_EQ(result.exit_code, 0);
  const std::string crate = "  name            crate\n";
  const std::size_t at = result.output.find(crate);
  ASSERT_NE(at, std::string::npos) << result.output;
  EXPECT_EQ(result.output.find(crate, at + 1), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("  status          built\n"), std::string::npos) << result.output;
}

TEST_F(WorldBuild, OtherFilesAndOptionsAreRefused) {
  std::ofstream(path("w.bullet")) << "this is no world at all";
  EXPECT_EQ(build().errors, "ambient_preprocess: " + path("w.bullet") +
                                ": is not a .bullet file: it does not begin with BULLET\n");
  EXPECT_EQ(build().exit_code, 1);
  EXPECT_EQ(run({path("w.bullet"), "-o", path("x")}).exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(path("x")));
  EXPECT_EQ(build({"--scale", "2"}).exit_code, 2);
  EXPECT_EQ(build({"--levels", "16"}).errors,
            "ambient_preprocess: --levels: is for one mesh, not for a world\n");
  EXPECT_EQ(build({"--scale", "2"}).errors,
            "ambient_preprocess: --scale: has no meaning for a world: its shapes keep frame and "
            "size\n");
  std::filesystem::create_directory(path("folder.bullet"));
  EXPECT_EQ(
      run({path("folder.bullet"), "-o", path("x")}).errors,
      "ambient_preprocess: " + path("folder.bullet") + ": is a directory, not a .bullet file\n");
  EXPECT_EQ(run({path("no.bullet"), "-o", path("x")}).errors,
            "ambient_preprocess: " + path("no.bullet") + ": no such file\n");
  EXPECT_FALSE(std::filesystem::exists(path("x")));
}

class DamagedWorld : public WorldBuild {
 protected:
  void SetUp() override {
    saveGoodWorld(path("w.bullet"));
    good_ = readText(path("w.bullet"));
  }

  // Returns the refusal, one line, without the file's name in front.
  std::string refusal(const std::string& bytes) const {
    writeText(path("w.bullet"), bytes);
    const ProgramResult result = build();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.output, "");
    const std::string beginning = "ambient_preprocess: " + path("w.bullet") + ": ";
    EXPECT_EQ(result.errors.find(beginning), 0u) << result.errors;
    return result.errors.substr(std::min(beginning.size(), result.errors.size()));
  }

  std::string changed(std::size_t at, const std::string& part) const {
    std::string bytes = good_;
    return bytes.replace(at, part.size(), part);
  }

  std::string good_;
};

// Header: 12 bytes. Chunk head: code, length, pointer of 8 bytes, structure, count.
TEST_F(DamagedWorld, IsRefusedBeforeBulletSeesIt) {
  ASSERT_EQ(build().exit_code, 0);
  const std::string all_ones(4, '\xff'), huge("\xff\xff\xff\x7f", 4);
  EXPECT_EQ(refusal(good_.substr(0, 9)), "damaged: it ends within its header\n");
  EXPECT_EQ(refusal(good_.substr(0, 12)), "damaged: it ends within the head of a chunk\n");
  EXPECT_EQ(refusal(good_.substr(0, good_.size() / 2)).find("damaged: it ends within "), 0u);
  EXPECT_EQ(refusal(good_.substr(0, good_.size() - 1)), "damaged: it ends within its DNA\n");
  EXPECT_EQ(refusal(changed(6, "x")), "damaged: its header is not valid\n");
  EXPECT_EQ(refusal(changed(8, "V")), "comes from a big-endian machine: not supported\n");
  EXPECT_EQ(refusal(changed(7, "_")).find("damaged: "), 0u);
  EXPECT_EQ(refusal(changed(16, all_ones)), "damaged: a chunk has a length of -1 bytes\n");
  EXPECT_EQ(refusal(changed(16, huge)), "damaged: it ends within a chunk\n");
  EXPECT_NE(refusal(changed(28, huge)).find("which it cannot hold"), std::string::npos);
  EXPECT_NE(refusal(changed(32, huge)).find("which it cannot hold"), std::string::npos);
  const std::size_t dna = good_.find("SDNANAME");
  EXPECT_EQ(refusal(changed(dna, "sdna")), "damaged: its DNA is not where it should be\n");
  EXPECT_EQ(refusal(changed(dna + 8, all_ones)), "damaged: the list of names has -1 entries\n");
  EXPECT_EQ(refusal(changed(good_.find("STRC") + 8, all_ones)),
            "damaged: its DNA refers to what it does not hold\n");
}

TEST_F(WorldBuild, ABodyWithAnEmptyNameIsOneWithoutAName) {
  btBoxShape box(btVector3(1, 1, 1));
  {
    SavedWorld world;
    world.add(box, 1, "");
    world.name(box, "");
    world.save(path("w.bullet"));
  }
  const ProgramResult result = build();
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(shapeOf(result, "body_0")["bodies"], json({"body 0"})) << result.output;
}

}  // namespace
}  // namespace ambient
