#pragma once

#include <nlohmann/json.hpp>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/force/law/pressure_law.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "demos/scene/scene.h"
#include "preprocess/shape/json_schema.h"

// Functions of several sources that read scenes.

namespace ambient {

/// Content of data/schema/scene.schema.json, compiled into the program.
const JsonSchema& sceneSchema();

/// Checks all conditions on a scene that the schema does not express.
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
void checkScene(const Scene& scene);

/// Tolerance for the norm of an orientation: rounding of printed digits.
constexpr double kQuaternionTolerance = 1e-6;

/// Tolerance for the limits of a separation angle: rounding of printed digits [rad].
constexpr double kAngleTolerance = 1e-6;

/// End of the line that refuses what is built with BULLET_AMBIENT_WHOLE_DEMO=ON only.
constexpr char kNeedsWholeDemo[] =
    "needs the whole ambient_demo: `demos/run SCENE`, or CMake's -DBULLET_AMBIENT_WHOLE_DEMO=ON";

/// Reads the entry of a robot and its URDF file. Adds the robot to scene.robots, and each link with
/// a collision shape to scene.bodies, named robot/link. @pre the schema has accepted the entry
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
void addRobot(const nlohmann::json& from, Scene& scene);

/// Reads the entry of a thruster. @pre scene.bodies and scene.robots are read
/// @throws std::runtime_error, one line that names the file, the place, the value and the limit.
ThrusterDef toThruster(const nlohmann::json& from, const Scene& scene);

/// Reads the entry of a foil likewise.
FoilDef toFoil(const nlohmann::json& from, const Scene& scene);

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
