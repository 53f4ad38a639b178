#pragma once

#include <filesystem>
#include <vector>

namespace ambient {

/// Installs handlers for SIGINT, SIGTERM and SIGHUP that end the program, and before that remove
/// these folders, outermost first, as far as they are empty. Call once.
void endOnSignals(const std::vector<std::filesystem::path>& folders);

/// From now on the first signal only sets wasInterrupted().
void hearSignals();

/// True after a signal: runs check it after each step and stop.
bool wasInterrupted() noexcept;

}  // namespace ambient
