#pragma once

#include <filesystem>
#include <vector>

namespace ambient {

/// Files and folders to remove if a run is aborted; outermost folder first.
struct Unfinished {
  std::vector<std::filesystem::path> files, folders;
};

/// Installs handlers for SIGINT, SIGTERM and SIGHUP. The first signal sets wasInterrupted(); the
/// second one removes the unfinished files and folders and ends the program. Call once.
void hearSignals(const Unfinished& unfinished = {});

/// True after a signal: runs check it after each step and stop.
bool wasInterrupted() noexcept;

}  // namespace ambient
