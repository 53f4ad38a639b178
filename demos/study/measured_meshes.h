#pragma once

#include <utility>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

// Meshes of measured bodies that are no primitives.

/// A profile of (radius, z) from below to above, turned about z; where it begins or ends off the
/// axis, the surface is open.
TriangleMesh turnedMesh(const std::vector<std::pair<double, double>>& profile);

/// The convex hull of few points.
TriangleMesh hullMesh(const std::vector<Eigen::Vector3d>& points);

/// Solid half of a ball of unit diameter, round side up; without `base` the open shell.
TriangleMesh hemisphereMesh(bool base);

/// The upper half of the wall of a pipe of unit diameter along y, open.
TriangleMesh halfPipeMesh(double length);

/// A symmetric aerofoil of four digits, turned; unit diameter, nose up.
TriangleMesh dropMesh(double length);

}  // namespace ambient
