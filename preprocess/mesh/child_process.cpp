#include "preprocess/mesh/child_process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <stdexcept>

namespace ambient {
namespace {

constexpr char kDone = 'd', kThrown = 't';

/// One end of a pipe.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  int number() const { return number_; }

 private:
  int number_;
};

bool writeAll(int descriptor, const std::string& bytes) {
  for (std::size_t written = 0; written < bytes.size();) {
    const ssize_t count = ::write(descriptor, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    written += static_cast<std::size_t>(count);
  }
  return true;
}

std::string readAll(int descriptor) {
  std::string bytes;
  std::array<char, 65536> part{};
  for (;;) {
    const ssize_t count = ::read(descriptor, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(part.data(), static_cast<std::size_t>(count));
  }
}

// A crash shall end the child by its signal, without anybody's handler, report or core file.
void prepareChild(int most_seconds) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU}) {
    ::signal(signal, SIG_DFL);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const auto seconds = static_cast<rlim_t>(most_seconds);
  const rlimit processor_time{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &processor_time);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the system's own interface
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
}

// The result with its kind in front; without the exit handlers of a process that lives on.
[[noreturn]] void becomeWorker(const std::function<std::string()>& work, int answer) {
  std::string bytes;
  try {
    bytes = kDone + work();
  } catch (const std::exception& error) {
    bytes = kThrown + std::string(error.what());
  } catch (...) {
    bytes = std::string(1, kThrown) + "an unknown exception";
  }
  ::_exit(writeAll(answer, bytes) ? 0 : 1);
}

void requireGoodEnd(int status, int most_seconds) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU) {
    throw ChildFailure("took more than " + std::to_string(most_seconds) + " s of processor time");
  }
  if (signal == SIGKILL) throw ChildFailure("was killed, perhaps for want of memory");
  throw ChildFailure("crashed");
}

}  // namespace

std::string runInChild(const std::function<std::string()>& work, int most_seconds) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw ChildFailure("could not be started");
  const Descriptor from_child(ends[0]);
  Descriptor to_parent(ends[1]);
  const pid_t child = ::fork();
  if (child < 0) throw ChildFailure("could not be started");
  if (child == 0) {
    prepareChild(most_seconds);
    becomeWorker(work, to_parent.number());
  }
  to_parent.close();
  std::string bytes = readAll(from_child.number());
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  requireGoodEnd(status, most_seconds);
  if (bytes.empty()) throw ChildFailure("ended without a result");
  const bool is_done = bytes.front() == kDone;
  bytes.erase(0, 1);
  if (!is_done) throw std::runtime_error(bytes);
  return bytes;
}

}  // namespace ambient
