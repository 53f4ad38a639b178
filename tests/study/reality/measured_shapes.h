#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

// Meshes of measured bodies other than primitives.

/// Surface of a profile of (radius, z) from bottom to top, turned about z. Open where the profile
/// begins or ends off the axis.
TriangleMesh turnedMesh(const std::vector<std::pair<double, double>>& profile);

/// Convex hull of a small number of points.
TriangleMesh hullMesh(const std::vector<Eigen::Vector3d>& points);

/// Prism along y; the corners (x, z) of its section are convex.
TriangleMesh prismMesh(const std::vector<std::pair<double, double>>& section, double length);

/// Wing along y of this length: a symmetric aerofoil of four digits, chord 1, nose at +x.
TriangleMesh aerofoilMesh(double thickness, double length);

/// Delta wing: triangular sheet of root chord 1, apex at +x, the tip 2 % of the root.
TriangleMesh deltaMesh(double aspect_ratio, int faces);

/// Shuttlecock as an open shell, cork up: unit diameter of the skirt, whose length is 1; a cork of
/// 0.43 by 0.42 with a round end.
TriangleMesh shuttlecockMesh();

/// Solid half of a ball of unit diameter, round side up; without `base` the open shell.
TriangleMesh hemisphereMesh(bool base);

/// The upper half of the wall of a pipe of unit diameter along y, open.
TriangleMesh halfPipeMesh(double length);

/// A symmetric aerofoil of four digits, turned; unit diameter, nose up.
TriangleMesh dropMesh(double length);

/// Makes a shape of data/reality/measurements.json by its `type`. Chord, height or edge are 1;
/// round shapes have unit diameter. Axis and normal of a plate are along z, the chord along x,
/// length along y. `size`: span of a plate, length of a cylinder, spheroid or drop, depth of a rod,
/// half angle of a cone [deg]. `width` and `thickness` of an ellipsoid or grain of length 1 (y, z;
/// x). `profile`: (radius, z) of a turned body, from bottom to top.
/// @throws std::invalid_argument that names an unknown shape, or std::runtime_error.
FluidBody makeMeasuredShape(const nlohmann::json& shape);
/// The same, made once in the program.
const FluidBody& measuredShape(const nlohmann::json& shape);

/// Motion of a measured body, and measured quantity: "flow" in data/reality/measurements.json.
struct MeasuredFlow {
  /// Measured quantity: "drag", "lift" of a ball on the frontal area; "normal" to a plate or wing,
  /// its "lift", on the plan area; "side": force across the axis of a hull, on the area ahead, per
  /// radian; "spin torque" over rho pi R^3 v^2 S; "stall angle" of largest lift [deg].
  std::string of;
  Vector3 velocity{1, 0, 0};  ///< velocity of the body
  bool is_mean = false;       ///< mean over directions, area of the sphere of equal volume
  double spin = 0;            ///< R w / V of a ball, w across the flow
  double reynolds = 1e5;      ///< on `length`
  double length = 1;          ///< over the unit of the shape
  double roughness = 0;       ///< height over the unit of the shape
  double area = 0;            ///< of the coefficient in units of the shape; 0: as `of` says
};

/// @throws std::invalid_argument that names the unknown quantity.
MeasuredFlow readMeasuredFlow(const nlohmann::json& flow);

/// Computes this quantity by the library. Settings other than law and roughness have their default.
double computeCoefficient(const FluidBody& body, const MeasuredFlow& flow, PressureLaw law);

/// Computes the terminal speed of a body with this weight, over the one that was measured.
/// drag: measured coefficient.
double computeSettling(const FluidBody& body, const MeasuredFlow& flow, double drag,
                       PressureLaw law);

}  // namespace ambient
