#pragma once

#include <string>
#include <vector>

namespace ambient {

/// What a program left behind.
struct ProgramResult {
  int exit_code = -1;  ///< -1 if a signal ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// Runs a program without a shell and waits for it.
ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments);

/// Starts a program, sends it SIGINT each time so many milliseconds have passed, and waits for it.
ProgramResult interruptProgram(const std::string& program,
                               const std::vector<std::string>& arguments, int milliseconds,
                               int times = 1);

}  // namespace ambient
