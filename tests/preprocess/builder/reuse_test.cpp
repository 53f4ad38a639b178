#include "preprocess/builder/reuse.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/solver_revision.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

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

}  // namespace
}  // namespace ambient
