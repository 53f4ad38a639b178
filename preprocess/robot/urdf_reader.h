#pragma once

#include <filesystem>
#include <string>

#include "preprocess/robot/robot_model.h"

namespace ambient {

/// Reads a URDF file: links, inertias, joints with limits, dynamics and mimics, collision geometry,
/// and three elements of our own, which other programs pass over:
///
///     <link name="blade">
///       <ambient medium="water" fluid_body="blade.ambient" law="form"/>
///       <collision><geometry><capsule radius="0.1" length="0.5"/></geometry></collision>
///       <collision><geometry><ellipsoid semi_axes="0.1 0.2 0.3"/></geometry></collision>
///
/// Mesh files are not opened here. docs/robots.md has the rules.
/// @throws std::runtime_error in one line that names the file, the element, value and limit: also
/// if this library was built without tinyxml2.
RobotModel readUrdf(const std::filesystem::path& file, const PackageFolders& packages = {});

/// Reads a robot from a text; `file` stands for it in messages, and relative paths begin at its
/// folder.
RobotModel parseUrdf(const std::string& text, const std::filesystem::path& file,
                     const PackageFolders& packages = {});

}  // namespace ambient
