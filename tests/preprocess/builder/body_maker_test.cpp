#include "preprocess/builder/body_maker.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/threads.h"

namespace ambient::test {
namespace {

/// Sets variables of the environment until the end of the test.
class UserFolder : public testing::Test {
 protected:
  ~UserFolder() override {
    for (const auto& [name, value] : before_) set(name, value);
  }
  void use(const char* name, const char* value) {
    const char* before = std::getenv(name);
    before_.emplace_back(name, before ? before : "");
    set(name, value);
  }
  static void set(const std::string& name, const std::string& value) {
    if (value.empty())
      unsetenv(name.c_str());
    else
      setenv(name.c_str(), value.c_str(), 1);
  }

 private:
  std::vector<std::pair<std::string, std::string>> before_;
};

TEST_F(UserFolder, IsThatOfTheEnvironment) {
  use("BULLET_AMBIENT_CACHE", "");
  use("XDG_CACHE_HOME", "");
  use("HOME", "/somewhere");
  EXPECT_EQ(userBodyFolder().path, "/somewhere/.cache/bullet_ambient");
  EXPECT_EQ(userBodyFolder().least, std::chrono::milliseconds(50));
  use("XDG_CACHE_HOME", "not/absolute");
  EXPECT_EQ(userBodyFolder().path, "/somewhere/.cache/bullet_ambient");
  use("XDG_CACHE_HOME", "/elsewhere");
  EXPECT_EQ(userBodyFolder().path, "/elsewhere/bullet_ambient");
  use("BULLET_AMBIENT_CACHE", "bodies");
  EXPECT_EQ(userBodyFolder().path, "bodies");
  use("BULLET_AMBIENT_CACHE", "off");
  EXPECT_EQ(userBodyFolder().path, "");
}

TEST_F(UserFolder, IsNoneWithoutAHome) {
  for (const char* name : {"BULLET_AMBIENT_CACHE", "XDG_CACHE_HOME", "HOME"}) use(name, "");
  EXPECT_EQ(userBodyFolder().path, "");
}

struct Said {
  std::vector<std::string> lines;
  BodyMaker maker{{}, [this](const std::string& line) { lines.push_back(line); }};

  void make(const std::string& name, int milliseconds, const std::string& whose = {}) {
    const auto work = [&](const auto& begin) {
      begin("solving the flow");
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      return FluidBody();
    };
    maker.get(name, {}, work, whose);
  }
};

TEST(BodyMaker, SaysAfterASecondWhatItMakes) {
  Said said;
  const auto begin = std::chrono::steady_clock::now();
  said.make("hull", 1500);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  ASSERT_FALSE(said.lines.empty());
  EXPECT_LE(static_cast<double>(said.lines.size()), time.count());
  EXPECT_EQ(said.lines[0], "making the fluid body of 'hull': solving the flow, 1 s");
}

TEST(BodyMaker, SaysForWhichBodyItWorksAndHowManyThereAre) {
  Said said;
  said.make("Convex", 1500, "body 'crane', 3 of 14");
  ASSERT_FALSE(said.lines.empty());
  EXPECT_EQ(said.lines[0],
            "making the fluid body of 'Convex' for body 'crane', 3 of 14: solving the flow, 1 s");
}

// A robot has many links.
TEST(BodyMaker, TakesBodiesOneAfterTheOtherForOneWork) {
  Said said;
  for (const char* name : {"upper arm", "lower arm"}) said.make(name, 700);
  ASSERT_FALSE(said.lines.empty());
  EXPECT_EQ(said.lines[0].rfind("making the fluid body of 'lower arm': ", 0), 0u) << said.lines[0];
}

TEST(BodyMaker, SaysNothingOfQuickWork) {
  Said said;
  for (int i = 0; i < 3; ++i) said.make("box", 1);
  EXPECT_TRUE(said.lines.empty());
  EXPECT_EQ(said.maker.counts().made, 3);
}

TEST(BodyMaker, OutlivesAReportThatThrows) {
  const TemporaryFolder folder;
  BodyMaker maker(folder / "a",
                  [](const std::string&) { throw std::runtime_error("no terminal"); });
  BodyMaker::Made made = maker.get("body", {}, [](const auto&) { return FluidBody(); });
  made.file = folder / "none" / "body.ambient";
  maker.keep(made);
  EXPECT_FALSE(std::filesystem::exists(made.file));
}

/// Captures the display's output on standard error, which is then not a terminal.
std::string shown(const std::function<void(ElapsedDisplay&)>& work, bool quiet = false) {
  ::testing::internal::CaptureStderr();
  {
    ElapsedDisplay display("building hull", quiet, std::chrono::milliseconds(20));
    work(display);
  }
  return ::testing::internal::GetCapturedStderr();
}

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(300)); }

TEST(ElapsedDisplay, WritesLinesWhereThereIsNoTerminal) {
  const std::string text = shown([](ElapsedDisplay& display) {
    display.begin("solving the flow");
    rest();
    display.update(0.42);
    rest();
  });
  EXPECT_NE(text.find("building hull: solving the flow, 0 s\n"), std::string::npos) << text;
  EXPECT_NE(text.find("building hull: solving the flow, 42 %\n"), std::string::npos) << text;
  EXPECT_EQ(text.find('\r'), std::string::npos) << text;
}

TEST(ElapsedDisplay, IsSilentIfItIsToldToOrHasNoThread) {
  EXPECT_EQ(shown([](ElapsedDisplay&) { rest(); }, true), "");
  const test::NoMoreThreads none;
  EXPECT_EQ(shown([](ElapsedDisplay&) { rest(); }), "");
}

ShapeBuildSettings quick() {
  ShapeBuildSettings settings;
  settings.name = "thing";
  settings.flow.max_panels = 0;
  return settings;
}

class Reuse : public ::testing::Test {
 protected:
  Reuse() : mesh_(folder_ / "m.obj"), file_(folder_ / "m.ambient") {
    writeText(mesh_, objText(makeBoxMesh({1, 2, 3}, 100)));
    writeFluidBody(buildShape(shape(), quick()).body, file_);
  }

  ShapeDescription shape(double scale = 1) const {
    return readShape({{"type", "mesh"}, {"file", "m.obj"}, {"scale", scale}}, folder_.path(), "s");
  }

  bool isSame(const ShapeDescription& shape, const ShapeBuildSettings& settings) const {
    return readIfSame(file_, settings.name, describeShape(shape, settings)).has_value();
  }

  TemporaryFolder folder_;
  std::filesystem::path mesh_, file_;
};

TEST_F(Reuse, AnUnchangedSourceIsRead) {
  ASSERT_TRUE(isSame(shape(), quick()));
  const auto body = readIfSame(file_, "thing", describeShape(shape(), quick()));
  EXPECT_EQ(encodeFluidBody(*body, "read"),
            encodeFluidBody(buildShape(shape(), quick()).body, "built"));
}

TEST_F(Reuse, AnotherSourceIsNot) {
  EXPECT_FALSE(isSame(shape(2), quick())) << "the scale in the shape counts";
  writeText(mesh_, objText(makeBoxMesh({1, 2, 3.001}, 100)));
  EXPECT_FALSE(isSame(shape(), quick()));
}

TEST_F(Reuse, OtherSettingsAreNot) {
  ShapeBuildSettings settings = quick();
  settings.scale = 2;
  EXPECT_FALSE(isSame(shape(), settings));
  settings = quick();
  settings.origin = Eigen::Vector3d::Zero();
  EXPECT_FALSE(isSame(shape(), settings));
  settings = quick();
  settings.flow.max_panels = 100;
  EXPECT_FALSE(isSame(shape(), settings));
  settings = quick();
  settings.least_faces = 100;
  EXPECT_FALSE(isSame(shape(), settings));
  settings = quick();
  settings.name = "other";
  EXPECT_FALSE(isSame(shape(), settings));
  settings = quick();
  settings.flow.threads = 1;
  settings.flow.memory_limit = 1e12;
  EXPECT_TRUE(isSame(shape(), settings)) << "threads and memory do not change the result";
  settings.flow.solver = FlowSolverKind::Hierarchical;
  EXPECT_FALSE(isSame(shape(), settings));
}

TEST_F(Reuse, AnotherRevisionOfTheSolverIsNot) {
  FluidBody body = readFluidBody(file_);
  std::string& generator = body.provenance.generator;
  const std::string revision = "solver revision " + std::to_string(kSolverRevision);
  const std::size_t at = generator.find(revision);
  ASSERT_NE(at, std::string::npos) << generator;
  generator.replace(at, revision.size(), "solver revision " + std::to_string(kSolverRevision - 1));
  writeFluidBody(body, file_);
  EXPECT_FALSE(isSame(shape(), quick()));
  generator.erase(at - 2);  // format before revisions existed
  writeFluidBody(body, file_);
  EXPECT_FALSE(isSame(shape(), quick()));
}

TEST_F(Reuse, OtherProgramsAndDamagedFilesAreNot) {
  Provenance provenance = describeShape(shape(), quick());
  provenance.generator += " next";
  EXPECT_FALSE(readIfSame(file_, "thing", provenance));
  std::ofstream(file_, std::ios::app) << "more";
  EXPECT_FALSE(isSame(shape(), quick()));
  std::filesystem::remove(file_);
  EXPECT_FALSE(isSame(shape(), quick()));
}

// Bodies that several callers share, and what could not be made.

TEST(SharedBodies, ThatCouldNotBeMadeAreMadeByTheNextCaller) {
  SharedBodies bodies;
  const auto body = std::make_shared<const FluidBody>();
  EXPECT_THROW(bodies.get("key", []() -> SharedBodies::Body { throw std::bad_alloc(); }),
               std::bad_alloc);
  EXPECT_EQ(bodies.get("key", [&] { return body; }), body);
  EXPECT_EQ(bodies.get("key", [] { return std::make_shared<const FluidBody>(); }), body);
}

}  // namespace
}  // namespace ambient::test
