#include "preprocess/command_line/option_values.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/base/plain_text.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/polar/polar.h"

namespace ambient {
namespace {

Vector3 parseAxis(const char* option, const std::string& text) {
  try {
    return axisNamed(text);
  } catch (const std::invalid_argument& error) {
    raiseUsageError(option, error.what());
  }
}

}  // namespace

void requirePositive(const char* option, double value, const char* unit) {
  if (std::isfinite(value) && value > 0) return;
  raiseUsageError(option, value, unit, " must be finite and positive");
}

void requireNotNegative(const char* option, double value, const char* unit) {
  if (std::isfinite(value) && value >= 0) return;
  raiseUsageError(option, value, unit, " must be finite and not negative");
}

void requireThreads(int threads) {
  constexpr int kMostThreads = 256;
  if (threads < 0) raiseUsageError("--threads", threads, " is below 0 (0: all cores)");
  if (threads > kMostThreads) raiseUsageError("--threads", threads, " is above ", kMostThreads);
}

void requireDivisions(const char* option, int count) {
  if (count < 0) raiseUsageError(option, count, " is below 0 (0: no division)");
  if (count > kMostDivisions) raiseUsageError(option, count, " is above ", kMostDivisions);
}

double wrapSizeOf(const std::string& text) {
  if (text == kDefaultWrap) return 0;
  char* end = nullptr;
  const double size = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0')
    raiseUsageError("--wrap", "\"", text, "\" is not a size in metres");
  requirePositive("--wrap", size, " m");
  return size;
}

double separationAngleOf(double angle) {
  constexpr double kStraight = kPi, kRight = kPi / 2;
  // An angle given with a few digits is still a right or a straight one.
  constexpr double kDigits = 1e-6;
  if (!(angle >= kRight * (1 - kDigits) && angle <= kStraight * (1 + kDigits)))
    raiseUsageError("--separation-angle", angle, " rad must lie between pi/2 and pi");
  return std::clamp(angle, kRight, kStraight);
}

PressureLaw lawOf(const std::string& name) {
  if (const auto law = valueOf(kPressureLawNames, name)) return *law;
  raiseUsageError("--law", "\"", name, "\" is neither published nor form");
}

Matrix3 flightAxesOf(const std::string& forward, const std::string& up) {
  const Vector3 ahead = parseAxis("--forward", forward), above = parseAxis("--up", up);
  if (ahead.dot(above) != 0) raiseUsageError("--up", up, " is along --forward ", forward);
  return flightAxes(ahead, above);
}

}  // namespace ambient
