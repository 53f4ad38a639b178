#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "demos/sweep/result_table.h"

namespace ambient {

/// Share of the cases of a file: cases whose index modulo `count` is `index`.
struct Shard {
  int index = 0, count = 1;

  /// Parses "I/N". @throws std::invalid_argument unless 0 <= I < N.
  static Shard parse(const std::string& text);
};

struct CaseSettings {
  std::filesystem::path cases;  ///< file of cases, see readCases()
  std::filesystem::path out;    ///< folder of the results of all shards
  Shard shard;
  int threads = 0;          ///< 0: all cores
  bool keep_motion = true;  ///< write trajectory.csv and geometry.json, too
  /// Called some times a second with the number of ended runs and of all runs; false: stop.
  std::function<bool(int ended, int runs)> watch = [](int, int) { return true; };
};

struct CaseCounts {
  int cases = 0;                        ///< number of cases of the shard
  int done_before = 0;                  ///< number of cases that had a result before
  std::map<int, std::string> failures;  ///< one sentence per failed case, by index of the case
};

/// Runs the cases of a shard that have no result yet. The result of a case is the folder
/// `out`/KEY, see keyOf(), with trajectory.csv, geometry.json and summary.json. summary.json is
/// completed last: a case with a complete one is done. The program may be killed at any moment and
/// started again, or run beside other shards; the results are the same. Failed cases are listed in
/// failedFile(), which is removed if no case failed.
/// @throws std::runtime_error if file or folder cannot be used; RunStopped if told to stop
CaseCounts runCases(const CaseSettings& settings);

/// File of failed cases: `out`/failed.jsonl; for one of several shards failed-I-of-N.jsonl.
std::filesystem::path failedFile(const CaseSettings& settings);

/// Result of a case by its key, see resultRows(); none if there is no readable summary.json.
std::optional<std::vector<TableRow>> resultOf(const std::filesystem::path& out,
                                              const std::string& key);

}  // namespace ambient
