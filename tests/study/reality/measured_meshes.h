#pragma once

#include <utility>
#include <vector>

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

}  // namespace ambient
