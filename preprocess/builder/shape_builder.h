#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Settings for making a fluid body from a shape.
struct ShapeBuildSettings {
  std::string name;                       ///< of the body
  std::optional<Eigen::Vector3d> origin;  ///< as in BuildSettings, in the shape's frame
  double scale = 1;                       ///< multiplies all lengths of the shape
  int least_faces = 0;                    ///< as in BuildSettings
  int waterline_subdivisions = 0;         ///< as in BuildSettings
  bool tables = true;  ///< of the added mass, as far as they reach; false: the flow is solved
  /// Settings of BuildSettings; whether it is a sheet, the shape says.
  PotentialFlowSettings flow{false, kDefaultPanels};
  /// Is told what is done from now on; null: nobody.
  std::function<void(const std::string& stage)> begin = nullptr;
};

/// A fluid body, and what a user should know about its mesh, one line each.
struct BuiltBody {
  FluidBody body;
  std::vector<std::string> warnings;
};

/// Makes the mesh of a shape and its fluid body; a FluidBodyFile is read from its file as it is.
/// Spheres and ellipsoids get the closed form of their added mass; boxes, cylinders, capsules and
/// cones that of the tables as far as these reach; unless a solver is named.
/// The provenance is the file and its hash, or the text of the shape.
/// @throws std::runtime_error in one line that names the file or the shape's source. A fluid body
/// can be neither moved nor scaled here.
BuiltBody buildShape(const ShapeDescription& shape, const ShapeBuildSettings& settings);

/// The provenance that buildShape() gives its result: the same provenance means the same result.
/// Reads the shape's file, if it has one.
/// @pre the shape is not a FluidBodyFile
/// @throws std::runtime_error if the file cannot be read, or as requireUsualExtents().
Provenance describeShape(const ShapeDescription& shape, const ShapeBuildSettings& settings);

}  // namespace ambient
