#include "demos/sweep/case_runs.h"

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "demos/simulation/output/geometry_text.h"
#include "demos/simulation/output/output_folder.h"
#include "demos/simulation/output/trajectory_text.h"
#include "demos/simulation/summary.h"
#include "demos/sweep/case_file.h"
#include "demos/sweep/sweep.h"
#include "preprocess/base/output_file.h"
#include "preprocess/shape/json_text.h"

namespace ambient {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

fs::path summaryFile(const fs::path& out, const std::string& key) {
  return out / key / "summary.json";
}

bool isDone(const fs::path& out, const std::string& key) { return resultOf(out, key).has_value(); }

/// Cases to run, and counts of all others.
struct Pending {
  std::vector<Scene> scenes;
  std::vector<int> indices;  ///< index of the case of each scene
  std::vector<std::string> keys;
  CaseCounts counts;
};

Pending findPending(const CaseSettings& settings) {
  Pending pending;
  std::set<std::string> seen;
  for (const Case& line : readCases(settings.cases)) {
    if (line.index % settings.shard.count != settings.shard.index) continue;
    ++pending.counts.cases;
    try {
      Scene scene = sceneOf(line);
      const std::string key = keyOf(scene);
      if (isDone(settings.out, key)) {
        ++pending.counts.done_before;
      } else if (seen.insert(key).second) {
        pending.scenes.push_back(std::move(scene));
        pending.indices.push_back(line.index);
        pending.keys.push_back(key);
      }
    } catch (const std::runtime_error& error) {
      pending.counts.failures.emplace(line.index, error.what());
    }
  }
  return pending;
}

/// Removes the partial files of a run that was killed.
void removePartialFiles(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".partial") fs::remove(entry.path());
}

void writeResult(const SweepRun& run, const CaseSettings& settings, const std::string& key) {
  const fs::path folder = settings.out / key;
  OutputFolder made(folder);
  if (settings.keep_motion) {
    writeFile(folder / "trajectory.csv", makeTrajectoryText(run.scene, run.record.motion));
    writeFile(folder / "geometry.json", makeGeometryText(run.scene, run.bodies));
  }
  writeFile(summaryFile(settings.out, key), makeSummary(run.scene, run.bodies, run.record));
  made.keep();
  removePartialFiles(folder);
}

void listFailures(const CaseSettings& settings, const std::map<int, std::string>& failures) {
  if (failures.empty()) {
    fs::remove(failedFile(settings));
    return;
  }
  std::string text;
  for (const auto& [index, sentence] : failures) {
    const json line{{"case", index}, {"error", sentence}};
    text += line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  }
  writeFile(failedFile(settings), text);
}

}  // namespace

Shard Shard::parse(const std::string& text) {
  Shard shard;
  char slash = 0;
  std::istringstream stream(text);
  stream >> shard.index >> slash >> shard.count;
  const bool is_read = !stream.fail() && slash == '/' && stream.peek() == EOF;
  if (!is_read || shard.index < 0 || shard.index >= shard.count)
    throw std::invalid_argument("--shard " + text + ": must be I/N with 0 <= I < N");
  return shard;
}

std::optional<std::vector<TableRow>> resultOf(const fs::path& out, const std::string& key) {
  try {
    return resultRows(readBytes(summaryFile(out, key)));
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

fs::path failedFile(const CaseSettings& settings) {
  if (settings.shard.count == 1) return settings.out / "failed.jsonl";
  return settings.out / ("failed-" + std::to_string(settings.shard.index) + "-of-" +
                         std::to_string(settings.shard.count) + ".jsonl");
}

CaseCounts runCases(const CaseSettings& settings) {
  const Pending pending = findPending(settings);
  OutputFolder out(settings.out);
  out.keep();
  SweepSettings sweep;
  sweep.threads = settings.threads;
  sweep.fluid_bodies = settings.out / "fluid_bodies";
  sweep.take = [&](const SweepRun& run) {
    const std::string& key = pending.keys[static_cast<std::size_t>(run.index)];
    try {
      writeResult(run, settings, key);
    } catch (const std::exception&) {
      // Ignored if another shard has meanwhile run an equal case, with the same result.
      if (!isDone(settings.out, key)) throw;
    }
  };
  const int runs = static_cast<int>(pending.scenes.size());
  sweep.watch = [&](int ended) { return settings.watch(ended, runs); };
  CaseCounts counts = pending.counts;
  for (const auto& [run, sentence] : runSweep(pending.scenes, sweep))
    counts.failures.emplace(pending.indices[static_cast<std::size_t>(run)], sentence);
  listFailures(settings, counts.failures);
  return counts;
}

}  // namespace ambient
