#include "tests/support/run_program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

// Between fork and exec: system calls only.
[[noreturn]] void becomeProgram(const std::vector<char*>& argv, const char* output,
                                const char* errors) {
  ::dup2(::open(output, O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
  ::dup2(::open(errors, O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

}  // namespace

ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const std::string output = (folder / "output").string();
  const std::string errors = (folder / "errors").string();
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) becomeProgram(argv, output.c_str(), errors.c_str());
  int status = 0;
  ::waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(output), readText(errors)};
}

}  // namespace ambient
