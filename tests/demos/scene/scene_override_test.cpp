#include <gtest/gtest.h>

#include "demos/integrators/integrators.h"
#include "demos/scene/scene_reader.h"
#include "tests/demos/scene/scene_refusals.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

using nlohmann::json;

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

}  // namespace
}  // namespace ambient
