#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "demos/sweep/result_table.h"

namespace ambient {

/// Which cases of a file: those whose index leaves the remainder `index` when divided by `count`.
struct Shard {
  int index = 0, count = 1;

  /// @throws std::invalid_argument unless the text is I/N with 0 <= I < N.
  static Shard parse(const std::string& text);
};

struct CaseSettings {
  std::filesystem::path cases;  ///< the file, see readCases()
  std::filesystem::path out;    ///< the folder of all shards' results
  Shard shard;
  int threads = 0;          ///< 0: all cores
  bool keep_motion = true;  ///< trajectory.csv and geometry.json, too
  /// Is told some times a second how many of so many runs have ended; false stops them.
  std::function<bool(int ended, int runs)> watch = [](int, int) { return true; };
};

struct CaseCounts {
  int cases = 0;                        ///< of the shard
  int done_before = 0;                  ///< that had their results already
  std::map<int, std::string> failures;  ///< by index of the case: one sentence
};

/// Runs the cases of a shard that have no result yet. The result of a case is the folder
/// `out`/KEY, see keyOf(): trajectory.csv and geometry.json as of a single run, and summary.json,
/// which gets its name last; a case that has one, whole, is done. Killed at any moment and started
/// again, or run beside other shards, it ends with the same results. Cases that failed are listed
/// in failedFile(), which is removed if none has.
/// @throws std::runtime_error if file or folder cannot be used; RunStopped.
CaseCounts runCases(const CaseSettings& settings);

/// `out`/failed.jsonl, of a shard failed-I-of-N.jsonl.
std::filesystem::path failedFile(const CaseSettings& settings);

/// resultRows() of a case that is done: one with a summary.json that can be read.
std::optional<std::vector<TableRow>> resultOf(const std::filesystem::path& out,
                                              const std::string& key);

}  // namespace ambient
