#include "demos/cases_command.h"

#include <chrono>
#include <cstdio>

#include "bullet_ambient/base/plain_text.h"
#include "demos/simulation/run_signals.h"
#include "demos/sweep/case_runs.h"
#include "demos/sweep/case_table.h"
#include "preprocess/base/output_file.h"
#include "preprocess/builder/elapsed_display.h"

namespace ambient {
namespace {

void writeTable(const CasesArguments& arguments) {
  const ResultTable table = collectCases(arguments.cases, arguments.out);
  writeFile(arguments.collect, makeTableText(table));
  if (!arguments.quiet)
    std::printf("%s: %zu rows of %zu columns, %d cases are not done\n",
                plainLine(arguments.collect).c_str(), table.rows.size(), table.columns.size(),
                table.missing);
}

CaseSettings settingsOf(const CasesArguments& arguments) {
  CaseSettings settings;
  settings.cases = arguments.cases;
  settings.out = arguments.out;
  settings.shard = Shard::parse(arguments.shard);
  settings.threads = arguments.threads;
  settings.keep_motion = !arguments.summaries;
  return settings;
}

}  // namespace

void checkCases(const CasesArguments& arguments) { Shard::parse(arguments.shard); }

bool runCasesCommand(const CasesArguments& arguments) {
  if (!arguments.collect.empty()) {
    writeTable(arguments);
    return true;
  }
  CaseSettings settings = settingsOf(arguments);
  hearSignals();
  int runs_ended = 0;
  CaseCounts counts;
  const auto start = std::chrono::steady_clock::now();
  {
    ElapsedDisplay display(arguments.cases + ": running", arguments.quiet);
    settings.watch = [&](int ended, int runs) {
      runs_ended = ended;
      if (runs > 0) display.update(static_cast<double>(ended) / runs);
      return !wasInterrupted();
    };
    counts = runCases(settings);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const std::size_t failed = counts.failures.size();
  if (!arguments.quiet)
    std::printf("%s: %d cases, %d done before, %d run in %.1f s, %zu failed\n",
                plainLine(arguments.cases).c_str(), counts.cases, counts.done_before, runs_ended,
                seconds.count(), failed);
  if (failed > 0)
    std::fprintf(stderr, "ambient_demo: %zu of %d cases failed, see %s; the first: %s\n", failed,
                 counts.cases, plainLine(failedFile(settings).string()).c_str(),
                 plainLine(counts.failures.begin()->second).c_str());
  return failed == 0;
}

}  // namespace ambient
