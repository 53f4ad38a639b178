#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace ambient {

// Each of these adds one command to ambient_preprocess. Parsing a command line with it runs it: its
// result goes to standard output, messages and progress go to standard error. Parsing then throws
// - CLI::RuntimeError with exit status 1 if the command has told about bad input and gone on;
// - UsageError in one line that names the option, the value and the limit;
// - std::runtime_error in one line that names the file, the entity and the limit.
void addBuild(CLI::App& app);
void addCheck(CLI::App& app);
void addExport(CLI::App& app);
void addUpgrade(CLI::App& app);
void addInspect(CLI::App& app);
void addLoads(CLI::App& app);
void addPolar(CLI::App& app);

/// Adds an option whose help shows `type` in place of its value.
template <class Value>
CLI::Option* addOption(CLI::App& command, const std::string& names, Value& value,
                       const std::string& type, const std::string& help) {
  return command.add_option(names, value, help)->type_name(type);
}

/// Adds --json.
inline void addJson(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "Print one JSON object instead of a table");
}

}  // namespace ambient
