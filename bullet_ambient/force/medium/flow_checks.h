#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Checks of what a flow is made of. Each throws std::invalid_argument, one line that names the
/// flow, the quantity, the value and the limit.
struct FlowChecks {
  const char* flow;

  void require(bool is_right, const std::string& what, double value, const char* limit) const {
    if (is_right) return;
    std::ostringstream sentence;
    sentence << flow << ": " << what << " is " << value << "; must be " << limit;
    throw std::invalid_argument(sentence.str());
  }
  const Vector3& finite(const std::string& what, const Vector3& value) const {
    require(value.allFinite(), what, value.norm(), "finite");
    return value;
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
