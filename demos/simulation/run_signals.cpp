#include "demos/simulation/run_signals.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

// Written before the handlers are installed, then only read by the handler.
std::vector<std::string> files, folders;
std::atomic<bool> is_interrupted{false};

// Signal handler: calls only async-signal-safe functions of POSIX.
void handle(int signal) {
  if (!is_interrupted.exchange(true)) return;
  for (const std::string& file : files) ::unlink(file.c_str());
  for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) ::rmdir(folder->c_str());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

void hearSignals(const Unfinished& unfinished) {
  AMBIENT_ASSERT(files.empty() && folders.empty());
  for (const std::filesystem::path& file : unfinished.files) files.push_back(file.string());
  for (const std::filesystem::path& folder : unfinished.folders) folders.push_back(folder.string());
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, handle);
}

bool wasInterrupted() noexcept { return is_interrupted; }

}  // namespace ambient
