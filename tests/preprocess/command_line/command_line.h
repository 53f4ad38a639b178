#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/support/refusals.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace ambient {

using Arguments = std::vector<std::string>;

inline Arguments appended(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Runs ambient_preprocess in a temporary folder.
class CommandLine : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    writeText(path(name), text);
    return path(name);
  }

  std::string bytesOfFile(const std::string& name) const { return readText(path(name)); }

  std::size_t fileCount() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      ++count;
    }
    return count;
  }

  static ProgramResult run(const Arguments& arguments) {
    return runProgram(AMBIENT_PREPROCESS, arguments);
  }

  static nlohmann::json resultOf(const Arguments& arguments) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    return nlohmann::json::parse(result.output);
  }

  /// Runs bad input; expects exit code 1, one line on standard error, nothing on standard output.
  static std::string refusal(const Arguments& arguments) { return lineOf(arguments, 1); }

  /// Runs an option with a bad value; expects refusal()'s output with exit code 2.
  static std::string usageRefusal(const Arguments& arguments) { return lineOf(arguments, 2); }

  /// Runs build on bad input; expects no file left behind.
  std::string buildRefusal(const std::string& input, const Arguments& more = {}) const {
    const std::size_t before = fileCount();
    const std::string message =
        refusal(appended({"build", input, "-o", path("out.ambient")}, more));
    EXPECT_EQ(fileCount(), before) << "a file was left behind";
    return message;
  }

  /// Expects the messages of a group of refusals.json about bad values of options after these
  /// arguments, and no file left behind.
  void expectUsageRefusals(const std::string& group, const Arguments& arguments) const {
    const std::size_t before = fileCount();
    expectRefusals(AMBIENT_COMMAND_REFUSALS, group, [&arguments](const Arguments& more) {
      return usageRefusal(appended(arguments, more));
    });
    EXPECT_EQ(fileCount(), before) << "a file was left behind";
  }

  TemporaryFolder folder_;

 private:
  static std::string lineOf(const Arguments& arguments, int exit_code) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    const std::string beginning = "ambient_preprocess: ";
    EXPECT_EQ(result.errors.find(beginning), 0u) << result.errors;
    return result.errors.substr(beginning.size(), result.errors.size() - beginning.size() - 1);
  }
};

/// Text of a sphere, quick to solve.
inline std::string sphereText() { return R"({"type":"sphere","radius":0.5,"faces":320})"; }

}  // namespace ambient
