#include "demos/simulation/run_signals.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

// Written before the handlers are installed, then only read by the handler.
std::vector<std::string> to_remove;
std::atomic<bool> is_heard{false}, is_interrupted{false};

// Signal handler: calls only async-signal-safe functions of POSIX.
void handle(int signal) {
  if (is_heard && !is_interrupted.exchange(true)) return;
  for (auto at = to_remove.rbegin(); at != to_remove.rend(); ++at) ::rmdir(at->c_str());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

void endOnSignals(const std::vector<std::filesystem::path>& folders) {
  AMBIENT_ASSERT(to_remove.empty());
  for (const std::filesystem::path& folder : folders) to_remove.push_back(folder.string());
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, handle);
}

void hearSignals() { is_heard = true; }

bool wasInterrupted() noexcept { return is_interrupted; }

}  // namespace ambient
