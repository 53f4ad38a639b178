#pragma once

#include <nlohmann/json.hpp>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/force/law/pressure_law.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

// Values of keys of a scene. @pre the schema has accepted them

inline Vector3 toVector(const nlohmann::json& v) {
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

/// Reads a vector; `absent` if the key is missing.
inline Vector3 vectorOr(const nlohmann::json& parent, const char* key, const Vector3& absent) {
  const auto found = parent.find(key);
  return found == parent.end() ? absent : toVector(*found);
}

/// Reads the key "orientation", a quaternion w, x, y, z; the identity if it is missing.
inline Quaternion orientationIn(const nlohmann::json& parent) {
  const auto q = parent.find("orientation");
  if (q == parent.end()) return Quaternion::Identity();
  return {(*q)[0].get<double>(), (*q)[1].get<double>(), (*q)[2].get<double>(),
          (*q)[3].get<double>()};
}

/// Reads the key "law"; `absent` if it is missing.
inline PressureLaw lawOr(const nlohmann::json& parent, PressureLaw absent) {
  return valueOf(kPressureLawNames, parent.value("law", "")).value_or(absent);
}

}  // namespace ambient
