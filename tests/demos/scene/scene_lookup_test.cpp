#include "demos/scene/scene_lookup.h"

#include <gtest/gtest.h>

#include "tests/demos/scene/scene_text.h"

namespace ambient {
namespace {

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
  try {
    findScene("c", {folder.path()});
    FAIL() << "found a scene that is not there";
  } catch (const std::exception& error) {
    EXPECT_STREQ(error.what(),
                 "scene \"c\" is not known; known are: a, b; or give the path of a .json file");
  }
}

}  // namespace
}  // namespace ambient
