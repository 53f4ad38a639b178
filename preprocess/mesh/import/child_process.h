#pragma once

#include <string>
#include <vector>

namespace ambient {

/// Exit status and output of a child process.
struct ChildResult {
  int exit_code = 0;
  int signal = 0;      ///< signal that ended the process; 0: none
  std::string output;  ///< standard output
};

/// Runs a program of this project, without a shell: `command` is its name and its arguments. The
/// program is taken from the folder of the running one, where the build and the installation put
/// both, else from the PATH. May be called from any thread.
/// @throws std::runtime_error if it cannot be started, with the reason.
ChildResult runChild(const std::vector<std::string>& command);

}  // namespace ambient
