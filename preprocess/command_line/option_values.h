#pragma once

#include <stdexcept>
#include <string>

#include "bullet_ambient/force/law/flow_settings.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/potential_flow/results/potential_flow.h"

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

// Each of these throws a UsageError that names the option, the value and the limit.

void requirePositive(const char* option, double value, const char* unit = "");
void requireNotNegative(const char* option, double value, const char* unit = "");
/// Requires 0 (all cores) to 256.
void requireThreads(int threads);
/// Requires 0 (no division) to kMostDivisions.
void requireDivisions(const char* option, int count);

/// Value of --wrap if no size is given.
constexpr const char* kDefaultWrap = "default";

/// The size of --wrap [SIZE] [m]: a number, or "default", which is 0.
double wrapSizeOf(const std::string& text);

/// The angle of --separation-angle, pi/2 to pi where its few digits miss them [rad].
double separationAngleOf(double angle);

/// Forward, left and up in F as columns, by the names of --forward and --up.
Matrix3 flightAxesOf(const std::string& forward, const std::string& up);

/// The law named by --law.
PressureLaw lawOf(const std::string& name);

}  // namespace ambient
