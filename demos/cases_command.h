#pragma once

#include <string>

namespace ambient {

/// Arguments of `ambient_demo --cases`.
struct CasesArguments {
  std::string cases, out, shard = "0/1", collect;
  int threads = 0;
  bool summaries = false;
  bool quiet = false;
};

/// Checks arguments that parse. @throws std::invalid_argument in one line.
void checkCases(const CasesArguments& arguments);

/// Runs the cases of a file, or, with `collect`, writes the table of their results. False if some
/// have failed.
/// @throws std::exception in one line.
bool runCasesCommand(const CasesArguments& arguments);

}  // namespace ambient
