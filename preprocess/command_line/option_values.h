#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/medium/medium.h"
#include "preprocess/mesh/holds/hold_search.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// A value or a combination of options that no input makes right; ends the program with the status
/// of wrong usage.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws UsageError always, in one line that begins with the option.
template <class... Parts>
[[noreturn]] void raiseUsageError(const std::string& option, const Parts&... parts) {
  throw UsageError(inputMessage(option, parts...));
}

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

// Each of these throws a UsageError that names the option, the value and the limit.

void requirePositive(const char* option, double value, const char* unit = "");
void requireNotNegative(const char* option, double value, const char* unit = "");
/// Requires density and viscosity that a world takes, faultOf().
void requireMedium(const Medium& medium);
/// Requires 0 (all cores) to 256.
void requireThreads(int threads);
/// Requires 0 (no division) to kMostDivisions.
void requireDivisions(const char* option, int count);

/// Value of --wrap if no size is given.
constexpr const char* kDefaultWrap = "default";

/// The size of --wrap [SIZE] [m]: a number, or "default", which is 0.
double wrapSizeOf(const std::string& text);

/// Forward, left and up in F as columns, by the names of --forward and --up.
Matrix3 flightAxesOf(const std::string& forward, const std::string& up);

/// Options that say how a fluid flows past a body.
struct FlowOptions {
  double roughness = 0;               // [m]
  double separation_angle = kPi / 2;  // [rad]
  std::string law = "form";
};

/// Adds --roughness, --separation-angle and --law.
void addFlowOptions(CLI::App& command, FlowOptions& options);

/// Reads them; says so of an angle that the law does not read.
/// @throws UsageError for values that are none.
FlowSettings flowOf(const FlowOptions& options);

/// True if a file name ends with an extension, such as ".json", in upper or lower case.
bool hasExtension(const std::filesystem::path& file, const std::string& extension);

/// Options that say how an INPUT is used.
struct InputOptions {
  bool sheet = false;  ///< an open surface of zero thickness
  bool hull = false;   ///< true: use the convex hull
  std::optional<std::string>
      wrap;             ///< use a closed surface around the mesh; value: its size [m] as text
  double scale = 1;     ///< factor on all lengths of the result
  bool strict = false;  ///< refuse what is not a closed body after mending, in place of wrapping it
  std::string holds = "auto";   ///< or "none"
  std::vector<double> up = {};  ///< which way the mesh stands; empty: not given
};

/// Adds --scale, --sheet, --hull, --wrap [SIZE], --strict, --holds and --up.
void addInputOptions(CLI::App& command, InputOptions& options);

/// Reads --holds and --up. @throws UsageError for words and directions that are none.
HoldSearch holdsOf(const InputOptions& options);

/// Reads the shape of an INPUT of the command line: a mesh file, or a JSON file with a shape.
/// @throws UsageError for options that exclude each other.
/// @throws std::runtime_error in one line that names the file.
ShapeDescription describeInput(const std::filesystem::path& input, const InputOptions& options);

/// Checks before the work that a file can be written.
/// @throws std::runtime_error if its folder does not exist, it is a folder, or it is the input.
void requireWritablePlace(const std::filesystem::path& output, const std::filesystem::path& input);

/// Checks that a fluid body would replace no foreign file: only a file with extension .ambient, or
/// one that begins like such a file, or nothing.
/// @throws std::runtime_error in one line that names the file, if something else stands there.
void requireReplaceable(const std::filesystem::path& output);

}  // namespace ambient
