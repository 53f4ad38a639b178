#pragma once

#include <string>
#include <vector>

namespace ambient {

/// Exit code and output of a program.
struct ProgramResult {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// Runs a program without a shell and waits for it.
ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace ambient
