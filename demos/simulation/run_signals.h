#pragma once

#include <filesystem>
#include <vector>

namespace ambient {

/// Files and folders of a run that is not over, the outermost folder first.
struct Unfinished {
  std::vector<std::filesystem::path> files, folders;
};

/// From here on the first SIGINT, SIGTERM or SIGHUP asks to stop, wasInterrupted(), and the second
/// one removes what is unfinished and ends the program at once. Called once.
void hearSignals(const Unfinished& unfinished = {});

/// Whether a signal has come: a run that is asked after each step stops then.
bool wasInterrupted() noexcept;

}  // namespace ambient
