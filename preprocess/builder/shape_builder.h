#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Settings for making a fluid body from a shape, which tells itself whether it is a sheet.
struct ShapeBuildSettings : CommonBuildSettings {
  double scale = 1;  ///< multiplies all lengths of the shape
  /// Whether tables of the added mass are used as far as they reach; false: the flow is solved.
  bool tables = true;
  /// "none"; "auto": those that the names of nodes in the mesh file tell, or that are found; or a
  /// JSON file that lists them, see planWings().
  std::string wings = "none";
};

/// A fluid body, and warnings about its mesh, one line each.
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
