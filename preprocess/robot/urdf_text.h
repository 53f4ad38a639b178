#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Attributes of an <ambient> element.
using AmbientAttributes = std::map<std::string, std::string>;

/// Geometry that URDF does not know, by its element and the numbers of its attributes.
struct OwnGeometry {
  std::string kind;        ///< "capsule", "ellipsoid"
  Vector3 sizes{0, 0, 0};  ///< radius, length; semi-axes
};

/// A URDF text in two parts.
struct UrdfText {
  std::string urdf;  ///< what urdfdom reads: links with inertia and collision, joints
  std::map<std::string, AmbientAttributes> ambient;  ///< by link
  /// By link, for each of its collisions; in `urdf` a sphere stands in its place.
  std::map<std::string, std::vector<std::optional<OwnGeometry>>> geometry;
};

/// Divides a URDF text. What neither moves nor collides is left out: visuals, materials, sensors.
/// @throws std::runtime_error in one line that begins with `source`, if it is not XML (with the
/// line), has no <robot>, or one of our own elements is wrong.
UrdfText divideUrdf(const std::string& text, const std::string& source);

}  // namespace ambient
