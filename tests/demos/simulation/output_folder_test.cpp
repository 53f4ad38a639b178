#include <gtest/gtest.h>

#include <fstream>

#include "demos/scene/scene_reader.h"
#include "demos/simulation/output/run_files.h"
#include "preprocess/shape/shape_mesh.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

TEST(OutputFolder, VanishesWithItsParentsUnlessKept) {
  const TemporaryFolder folder;
  { const OutputFolder output(folder / "a/b/c"); }
  EXPECT_TRUE(folder.empty());
  {
    OutputFolder output(folder / "a/b/c");
    output.keep();
  }
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
}

TEST(OutputFolder, KeepsAFolderThatWasThere) {
  const TemporaryFolder folder;
  { const OutputFolder output(folder.path()); }
  EXPECT_TRUE(std::filesystem::is_directory(folder.path()));
}

TEST(OutputFolder, CannotBeAFile) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "x";
  EXPECT_THROW(OutputFolder(folder / "a"), std::runtime_error);
  EXPECT_THROW(OutputFolder(folder / "a/b"), std::runtime_error);
}

TEST(TrajectoryText, RowsCarrySeventeenDigitsInTheOrderOfTheHeader) {
  MotionSample sample;
  sample.time = 0.1;
  sample.position = Vector3(1.0 / 3, 2, -1e-7);
  sample.orientation = Quaternion(0.5, -0.5, 0.5, -0.5);
  sample.twist = {Vector3(4, 5, 6), Vector3(7, 8, 9)};
  EXPECT_STREQ(kTrajectoryHeader, "time,body,px,py,pz,qw,qx,qy,qz,wx,wy,wz,vx,vy,vz");
  EXPECT_EQ(trajectoryRow("plate", sample),
            "0.10000000000000001,plate,0.33333333333333331,2,-9.9999999999999995e-08,"
            "0.5,-0.5,0.5,-0.5,4,5,6,7,8,9\n");
}

TEST(SceneFiles, AreAllValidAndDescribed) {
  const auto files = listScenes({std::filesystem::path(AMBIENT_DATA) / "scenes"});
  EXPECT_GE(files.size(), 8u);
  for (const auto& file : files) {
    const Scene scene = readScene(file);
    EXPECT_FALSE(scene.description.empty()) << file;
    for (const BodyDef& body : scene.bodies) {
      const auto shape_file = fileOf(body.shape);
      EXPECT_TRUE(shape_file.empty() || std::filesystem::exists(shape_file)) << shape_file;
    }
  }
}

}  // namespace
}  // namespace ambient
