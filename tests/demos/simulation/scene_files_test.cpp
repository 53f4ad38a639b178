#include <gtest/gtest.h>

#include "demos/scene/scene_lookup.h"
#include "preprocess/shape/shape_mesh.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

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
