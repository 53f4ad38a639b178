#include "demos/sweep/case_runs.h"

#include <gtest/gtest.h>

#include "demos/simulation/scene_run.h"
#include "demos/sweep/case_table.h"
#include "tests/demos/sweep/ball_cases.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

CaseSettings settingsOf(const fs::path& cases, const fs::path& out, Shard shard = {}) {
  CaseSettings settings;
  settings.cases = cases;
  settings.out = out;
  settings.shard = shard;
  return settings;
}

/// Contents of all result files by path, without run times.
std::map<std::string, std::string> resultsIn(const fs::path& out) {
  std::map<std::string, std::string> results;
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    const std::string name = fs::relative(entry.path(), out).string();
    if (!entry.is_regular_file() || name.rfind("fluid_bodies", 0) == 0) continue;
    std::string text = readText(entry.path());
    if (entry.path().filename() == "summary.json") {
      auto summary = nlohmann::json::parse(text);
      summary.erase("wall_seconds_simulation");
      text = summary.dump();
    }
    results[name] = text;
  }
  return results;
}

TEST(Shards, AreReadAndRefused) {
  EXPECT_EQ(Shard::parse("3/64").index, 3);
  EXPECT_EQ(Shard::parse("3/64").count, 64);
  for (const char* text : {"", "3", "3/", "4/4", "-1/4", "0/0", "1/4x", "a/b"})
    EXPECT_THROW(Shard::parse(text), std::invalid_argument) << text;
}

TEST(CaseRuns, ShardsMakeTheResultsOfTheWhole) {
  const TemporaryFolder folder;
  const fs::path cases = writeMasses(folder, {0.1, 0.2, 0.3, 0.4, 0.5});
  const CaseCounts whole = runCases(settingsOf(cases, folder / "whole"));
  EXPECT_EQ(whole.cases, 5);
  EXPECT_EQ(whole.done_before, 0);
  EXPECT_EQ(runCases(settingsOf(cases, folder / "shards", {1, 2})).cases, 2);
  EXPECT_EQ(runCases(settingsOf(cases, folder / "shards", {0, 2})).cases, 3);
  const auto results = resultsIn(folder / "whole");
  EXPECT_EQ(results.size(), 5u * 3);
  EXPECT_EQ(resultsIn(folder / "shards"), results);
}

TEST(CaseRuns, WhatIsDoneIsNotRunAgain) {
  const TemporaryFolder folder;
  const fs::path cases = writeMasses(folder, {0.1, 0.2, 0.2});
  EXPECT_EQ(runCases(settingsOf(cases, folder / "out")).done_before, 0);
  // Equal cases share one result.
  EXPECT_EQ(resultsIn(folder / "out").size(), 2u * 3);
  CaseSettings again = settingsOf(cases, folder / "out");
  int runs = -1;
  again.watch = [&](int, int count) {
    runs = count;
    return true;
  };
  EXPECT_EQ(runCases(again).done_before, 3);
  EXPECT_EQ(runs, 0);
}

TEST(CaseRuns, AResultWithoutItsSummaryIsMadeAgain) {
  const TemporaryFolder folder;
  const fs::path cases = writeMasses(folder, {0.1, 0.2});
  runCases(settingsOf(cases, folder / "out"));
  const auto results = resultsIn(folder / "out");
  for (const auto& [name, text] : results)
    if (fs::path(name).filename() == "summary.json") fs::remove(folder / "out" / name);
  const fs::path torn = folder / "out" / fs::path(results.begin()->first).parent_path();
  writeText(torn / "trajectory.csv", "time,bo");
  writeText(torn / ".ambient-1.partial", "{");
  EXPECT_EQ(runCases(settingsOf(cases, folder / "out")).done_before, 0);
  EXPECT_EQ(resultsIn(folder / "out"), results);
}

TEST(CaseRuns, ListsThoseThatFailedUntilTheyAreMended) {
  const TemporaryFolder folder;
  const fs::path cases = folder / "cases.jsonl";
  const std::string good = caseLine(shortFlight(), {{"bodies.0.mass", 0.2}});
  const std::string torn = caseLine(shortFlight(), {{"bodies.0.linear_velocity", {1e200, 0, 0}}});
  writeText(cases, good + torn + "{\"scene\": 1}\n");
  const CaseSettings settings = settingsOf(cases, folder / "out");
  const CaseCounts counts = runCases(settings);
  ASSERT_EQ(counts.failures.size(), 2u);
  EXPECT_NE(counts.failures.at(1).find("not finite"), std::string::npos);
  EXPECT_NE(counts.failures.at(2).find("cases.jsonl:3: \"scene\" must be"), std::string::npos);
  const std::string list = readText(folder / "out/failed.jsonl");
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 2);
  EXPECT_EQ(nlohmann::json::parse(list.substr(0, list.find('\n')))["case"], 1);
  const ResultTable table = collectCases(cases, folder / "out");
  EXPECT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.missing, 2);
  EXPECT_THROW(collectCases(cases, folder / "elsewhere"), std::runtime_error);

  writeText(cases, good);
  EXPECT_EQ(runCases(settings).done_before, 1);
  EXPECT_FALSE(fs::exists(folder / "out/failed.jsonl"));
}

TEST(CaseRuns, RunAgainWhatHasNoWholeSummary) {
  const TemporaryFolder folder;
  const fs::path cases = writeMasses(folder, {0.1});
  const CaseSettings settings = settingsOf(cases, folder / "out");
  runCases(settings);
  const auto results = resultsIn(folder / "out");
  for (const auto& [file, text] : results)
    if (fs::path(file).filename() == "summary.json") writeText(folder / "out" / file, "garbage");
  EXPECT_EQ(collectCases(cases, folder / "out").missing, 1);
  EXPECT_EQ(runCases(settings).done_before, 0);
  EXPECT_EQ(resultsIn(folder / "out"), results);
}

TEST(CaseRuns, MayKeepTheSummaryAlone) {
  const TemporaryFolder folder;
  const fs::path cases = writeMasses(folder, {0.1});
  CaseSettings settings = settingsOf(cases, folder / "out");
  settings.keep_motion = false;
  runCases(settings);
  const auto results = resultsIn(folder / "out");
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(fs::path(results.begin()->first).filename(), "summary.json");
}

TEST(CaseRuns, StopWhenTold) {
  const TemporaryFolder folder;
  const fs::path cases = writeMasses(folder, {0.1, 0.2});
  CaseSettings settings = settingsOf(cases, folder / "out");
  settings.watch = [](int, int) { return false; };
  EXPECT_THROW(runCases(settings), RunStopped);
}

TEST(CaseTable, HasTheOrderOfTheFileAndTheOverrides) {
  const TemporaryFolder folder;
  const fs::path cases = folder / "cases.jsonl";
  writeText(cases, caseLine(shortFlight(), {{"bodies.0.mass", 2}}) +
                       caseLine(shortFlight(), {{"model", "vacuum"}, {"bodies.0.mass", 1}}));
  runCases(settingsOf(cases, folder / "out"));
  const ResultTable table = collectCases(cases, folder / "out");
  ASSERT_EQ(table.rows.size(), 2u);
  const std::vector<std::string> first(table.columns.begin(), table.columns.begin() + 6);
  EXPECT_EQ(first,
            (std::vector<std::string>{"case", "key", "bodies.0.mass", "model", "body", "mass"}));
  EXPECT_EQ(std::get<double>(table.rows[0][2]), 2);
  EXPECT_EQ(std::get<double>(table.rows[1][5]), 1);
  EXPECT_EQ(std::get<std::string>(table.rows[1][3]), "vacuum");
  EXPECT_TRUE(std::isnan(std::get<double>(table.rows[0][3])));
  // Vacuum: constant velocity, x = 30 t.
  EXPECT_NEAR(std::get<double>(table.rows[1][7]), 3, 1e-12);
}

}  // namespace
}  // namespace ambient
