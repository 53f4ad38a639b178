#include "preprocess/mesh/import/child_process.h"

#include <gtest/gtest.h>

#include <csignal>

#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

ChildResult runShell(const std::string& text) { return runChild({"sh", "-c", text}); }

TEST(ChildProcess, ReturnsWhatTheProgramWrites) {
  EXPECT_EQ(runShell("exit 0").output, "");
  const std::string zeros = runShell("head -c 3000000 /dev/zero").output;  // exceeds a pipe
  EXPECT_EQ(zeros, std::string(3'000'000, '\0'));
}

TEST(ChildProcess, PassesArgumentsAsTheyAre) {
  const std::string word = "a b; echo $HOME '\"*";
  EXPECT_EQ(runChild({"printf", "%s", word}).output, word);
}

TEST(ChildProcess, TellsHowTheProgramEnded) {
  EXPECT_EQ(runShell("exit 3").exit_code, 3);
  EXPECT_EQ(runShell("kill -SEGV $$").signal, SIGSEGV);
  EXPECT_EQ(runShell("ulimit -S -t 1; while :; do :; done").signal, SIGXCPU);
}

TEST(ChildProcess, ProgramsThatAreMissingAreNamed) {
  EXPECT_EQ(messageOf([] { runChild({"no_such_program"}); }),
            "the program no_such_program could not be started: it is neither beside this program "
            "nor on the PATH");
}

}  // namespace
}  // namespace ambient
