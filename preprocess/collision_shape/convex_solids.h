#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/collision_shape/solid.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Triangles that many solids have together at most, over those aimed at, as far as they can.
constexpr int kMostOfMany = 6;

/// How finely round solids are made.
struct SolidResolution {
  int faces = 0;        ///< triangles aimed at for the loads, of all solids together
  int least_faces = 0;  ///< of each of them, unless that makes more than kMostOfMany allows
  int flow_faces = 0;   ///< as `faces`, for the flow
  bool tables = true;   ///< of the added mass, as far as they reach
};

/// An ellipsoid of Bullet's btMultiSphereShape.
struct HullBall {
  Eigen::Vector3d centre;
  Eigen::Vector3d semi_axes;
};

// All lengths in metres. `name` begins the message of every std::runtime_error: sizes that are not
// positive and finite, points in a plane.

Solid makeBallSolid(double radius, const SolidResolution& resolution, const std::string& name);
Solid makeBoxSolid(const Eigen::Vector3d& half_sizes, const SolidResolution& resolution,
                   const std::string& name);
/// Axis along z, full height.
Solid makeCylinderSolid(double radius, double height, const SolidResolution& resolution,
                        const std::string& name);
/// Axis along z, height of the cylindrical part; 0: a ball.
Solid makeCapsuleSolid(double radius, double height, const SolidResolution& resolution,
                       const std::string& name);
/// Axis along z, apex at +height/2, all points within `margin` of the cone.
Solid makeConeSolid(double radius, double height, double margin, const SolidResolution& resolution,
                    const std::string& name);
/// Convex hull of points and all points within `margin` of it; its volume follows Steiner's
/// formula.
Solid makeHullSolid(const std::vector<Eigen::Vector3d>& points, double margin,
                    const SolidResolution& resolution, const std::string& name);
/// Convex hull of balls; its volume is extrapolated from two approximations by polyhedra.
Solid makeBallHullSolid(const std::vector<HullBall>& balls, const SolidResolution& resolution,
                        const std::string& name);

/// The same surface in triangles with edges at most 2.5 times as long as those of equilateral ones
/// of that number; longer if narrow strips would make more than twice as many.
TriangleMesh evenlyDivided(const TriangleMesh& mesh, int faces);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
