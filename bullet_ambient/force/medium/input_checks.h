#pragma once

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Throws std::invalid_argument with one line made of its parts.
template <class... Parts>
[[noreturn]] void refuseInput(const Parts&... parts) {
  std::ostringstream line;
  (line << ... << parts);
  throw std::invalid_argument(line.str());
}

/// Checks of numbers that a program gives. Each throws std::invalid_argument, one line that names
/// the thing, the quantity, the value and the limit.
struct InputChecks {
  const char* thing = "";  ///< empty: the quantities name it

  void require(bool is_right, const std::string& what, double value, const char* limit) const {
    if (!is_right) refuseInput(thing, *thing ? ": " : "", what, " is ", value, "; must be ", limit);
  }
  void finite(const std::string& what, double value) const {
    require(std::isfinite(value), what, value, "finite");
  }
  const Vector3& finite(const std::string& what, const Vector3& value) const {
    require(value.allFinite(), what, value.norm(), "finite");
    return value;
  }
  void positive(const std::string& what, double value) const {
    require(value > 0 && std::isfinite(value), what, value, "positive and finite");
  }
  void notNegative(const std::string& what, double value) const {
    require(value >= 0 && std::isfinite(value), what, value, "zero or positive and finite");
  }
  void within(const std::string& what, double value, double lowest, double highest) const {
    if (value >= lowest && value <= highest) return;
    std::ostringstream limit;
    limit << "from " << lowest << " to " << highest;
    require(false, what, value, limit.str().c_str());
  }
  /// Returns the unit vector along a direction.
  Vector3 direction(const char* what, const Vector3& value) const {
    const double length = value.norm();
    require(length > 0 && value.allFinite(), std::string("length of ") + what, length,
            "positive and finite");
    return value / length;
  }
};

}  // namespace ambient
