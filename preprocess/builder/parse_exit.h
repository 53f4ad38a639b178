#pragma once

#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <sstream>
#include <string>

#include "bullet_ambient/base/plain_text.h"

namespace ambient {

/// Blocks SIGINT, SIGTERM and SIGHUP while it exists, so that files are renamed either all or not
/// at all. Blocked signals arrive when it is destroyed.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_{};
};

/// Exit code of a program whose command line cannot be used.
constexpr int kBadUsage = 2;
/// Exit code of a program that has failed otherwise.
constexpr int kBadInput = 1;

/// Returns a sentence about an argument without letters, mostly a variable of the shell that is not
/// set; empty: there is none. CLI11 takes it for 0 where it should be a number, and programs for an
/// option that was not given.
inline std::string emptyArgument(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0') return "argument " + std::to_string(i) + " is empty";
  return {};
}

/// Prints help to standard output, or an error that begins with the program's name, which `app`
/// has. Returns the exit code of the program: 0 after help. App and Error are CLI11's.
template <class App, class Error>
int exitAt(const App& app, const Error& error) {
  std::ostringstream errors;
  const int code = app.exit(error, std::cout, errors);
  if (code == 0) return 0;
  std::cerr << app.get_name() << ": " << plainText(errors.str());
  return kBadUsage;
}

/// Runs the body of a program and returns its exit code. Prints an exception of `run`, and that
/// standard output cannot be written, in one line that begins with the program's name.
template <class Run>
int runProgram(const char* name, const Run& run) {
  // Beyond a limit of the file size, writing fails with a message in place of ending the program.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const int exit_code = run();
    std::cout.flush();
    if (exit_code != 0 || (std::cout && std::fflush(stdout) == 0)) return exit_code;
    std::cerr << name << ": the result cannot be written to standard output\n";
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": there is not enough memory for an input of this size\n";
  } catch (const std::exception& error) {
    std::cerr << name << ": " << plainLine(error.what()) << "\n";
  }
  return kBadInput;
}

}  // namespace ambient
