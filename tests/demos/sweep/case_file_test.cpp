#include "demos/sweep/case_file.h"

#include <gtest/gtest.h>

#include "tests/demos/sweep/ball_cases.h"

namespace ambient {
namespace {

using nlohmann::json;

/// Returns the first case of a one-line file.
Case caseIn(const TemporaryFolder& folder, const std::string& text) {
  writeText(folder / "cases.jsonl", text);
  return readCases(folder / "cases.jsonl").at(0);
}

std::string complaintAboutCase(const std::string& text) {
  const TemporaryFolder folder;
  try {
    sceneOf(caseIn(folder, text));
  } catch (const std::runtime_error& error) {
    const std::string sentence = error.what();
    const std::string start = (folder / "cases.jsonl").string() + ":1: ";
    return sentence.rfind(start, 0) == 0 ? sentence.substr(start.size()) : sentence;
  }
  return "";
}

std::string keyWith(const json& set) {
  const TemporaryFolder folder;
  return keyOf(sceneOf(caseIn(folder, caseLine(shortFlight(), set))));
}

TEST(CaseFile, CountsCasesNotBlankLines) {
  const TemporaryFolder folder;
  writeText(folder / "cases.jsonl", "{}\n\n  \n[]\n");
  const std::vector<Case> cases = readCases(folder / "cases.jsonl");
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[1].index, 1);
  EXPECT_EQ(cases[1].source, (folder / "cases.jsonl").string() + ":4");
}

TEST(CaseFile, AWholeSceneTakesItsOverrides) {
  const TemporaryFolder folder;
  const Scene scene = sceneOf(
      caseIn(folder, caseLine(shortFlight(), {{"bodies.0.mass", 0.1}, {"gravity", {0, 0, -1}}})));
  EXPECT_EQ(scene.bodies[0].mass, 0.1);
  EXPECT_EQ(scene.gravity, Vector3(0, 0, -1));
}

TEST(CaseFile, APathIsRelativeToTheFileOfCases) {
  const TemporaryFolder folder;
  writeScene(folder, shortFlight().dump(), "fall.json");
  EXPECT_EQ(sceneOf(caseIn(folder, caseLine("fall.json", json::object()))).name, "fall");
}

TEST(CaseFile, ANameIsASceneOfTheLibrary) {
  const TemporaryFolder folder;
  EXPECT_EQ(sceneOf(caseIn(folder, R"({"scene": "plate_8cm"})")).name, "plate_8cm");
}

TEST(CaseFile, RefusesWhatIsNoCase) {
  EXPECT_EQ(complaintAboutCase("[]"), "a case must be an object");
  EXPECT_EQ(complaintAboutCase("{\"set\": {}}"), "\"scene\" is missing");
  EXPECT_EQ(complaintAboutCase(R"({"scene": 3})"), "\"scene\" must be a name, a path or a scene");
  EXPECT_EQ(complaintAboutCase(R"({"scene": "plate_8cm", "sets": {}})"),
            "unknown key \"sets\" in a case, which has scene and set");
  EXPECT_NE(complaintAboutCase(R"({"scene": "gone.json"})").find("gone.json: no such file"),
            std::string::npos);
  EXPECT_NE(complaintAboutCase(caseLine(shortFlight(), {{"bodies.0.mass", -1}}))
                .find("bodies[0].mass is -1"),
            std::string::npos);
}

TEST(CaseKey, IsOfWhatTheRunDependsOn) {
  const std::string key = keyWith(json::object());
  EXPECT_EQ(key.size(), 16u);
  EXPECT_EQ(keyWith({{"bodies.0.mass", 0.43}}), key);  // equals the default
  EXPECT_EQ(keyWith({{"description", "a ball"}, {"threads", 3}}), key);
  EXPECT_EQ(keyWith({{"bodies.0.position", {0.0, 0.0, 1.0}}}), key);
  EXPECT_NE(keyWith({{"bodies.0.mass", 0.44}}), key);
}

TEST(CaseKey, IsOfTheBytesOfAMesh) {
  const TemporaryFolder folder;
  const auto key = [&](const std::string& bytes) {
    writeText(folder / "body.obj", bytes);
    return keyOf(sceneOf(caseIn(
        folder,
        caseLine(shortFlight(), {{"bodies.0.shape", {{"type", "mesh"}, {"file", "body.obj"}}}}))));
  };
  const std::string first = key("v 0 0 0\n");
  EXPECT_EQ(key("v 0 0 0\n"), first);
  EXPECT_NE(key("v 0 0 1\n"), first);
}

}  // namespace
}  // namespace ambient
