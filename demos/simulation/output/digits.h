#pragma once

#include <cstdio>
#include <string>

namespace ambient {

/// Text of a number with 17 significant digits.
inline std::string digits17(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace ambient
