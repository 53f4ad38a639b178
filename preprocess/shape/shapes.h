#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "preprocess/mesh/holds/hold_search.h"

namespace ambient {

// Shapes in their own frame S, lengths in metres. Solids are centred at the origin, round ones have
// their axis along z; sheets lie in the x-y plane with normal +z.

struct Sphere {
  double radius = 0;
};
struct Box {
  Eigen::Vector3d half_sizes = Eigen::Vector3d::Zero();
};
struct Ellipsoid {
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Zero();
};
struct Cylinder {
  double radius = 0;
  double height = 0;
};
struct Capsule {
  double radius = 0;
  double height = 0;  ///< of the cylindrical part; 0: a sphere
};
struct Cone {
  double radius = 0;
  double height = 0;  ///< apex at +height/2
};
/// Convex hull of points.
struct Hull {
  std::vector<Eigen::Vector3d> points;
};
/// Convex hull of ellipsoids whose axes are those of S.
struct BallHull {
  struct Ball {
    Eigen::Vector3d centre, semi_axes;
  };
  std::vector<Ball> balls;
};
/// A closed surface.
struct TriangleSoup {
  std::vector<Eigen::Vector3d> corners;  ///< three per triangle, counter-clockwise from outside [m]
};
/// Surface that is used for a mesh file: its own triangles, their convex hull, or a wrap.
enum class MeshStandIn { kNone, kHull, kWrap };
struct MeshFile {
  std::filesystem::path file;
  double scale = 1;
  MeshStandIn stand_in = MeshStandIn::kNone;
  double wrap_size = 0;              ///< with kWrap, before any scaling [m]; 0: kDefaultWrapSize
  Eigen::Vector3d stretch{1, 1, 1};  ///< along the axes of the file, after `scale`; not 0
  bool strict = false;  ///< with kNone: what is not a closed body is refused, not wrapped
  bool sheet = false;   ///< an open surface of zero thickness, as it is: file and scale count
};
struct FluidBodyFile {
  std::filesystem::path file;
};
struct RectangleSheet {
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
};
struct EllipseSheet {
  Eigen::Vector2d semi_axes = Eigen::Vector2d::Zero();
};
struct PlacedShape;
/// Solids that are one body: where they overlap or touch, they are united.
struct Compound {
  std::vector<PlacedShape> parts;
};

using Shape =
    std::variant<Sphere, Box, Ellipsoid, Cylinder, Capsule, Cone, Hull, BallHull, TriangleSoup,
                 MeshFile, FluidBodyFile, RectangleSheet, EllipseSheet, Compound>;

/// p_parent = pose * p_child [m].
using RigidPose = Eigen::Transform<double, 3, Eigen::Isometry, Eigen::DontAlign>;

/// A shape with its pose in the frame of the whole.
struct PlacedShape {
  Shape shape = {};
  RigidPose pose = RigidPose::Identity();
  std::string name = {};  ///< begins messages: "crane: child 1: child 0 (Box)"
};

/// A shape as data/schema/shape.schema.json describes it.
struct ShapeDescription {
  static constexpr int kDefaultFaces = 1300;

  Shape geometry;
  bool has_holds = true;  ///< false: rooms of a mesh or compound do not stay dry
  std::vector<std::filesystem::path> tanks = {};  ///< files as HoldSearch::tanks
  std::vector<GivenOpening> openings = {};        ///< in the frame of the shape
  std::string wings = "none";  ///< as ShapeBuildSettings::wings, which go before it
  int faces = kDefaultFaces;   ///< triangles aimed at, where the shape has no mesh of its own
  std::string text;            ///< the description, as JSON on one line
  std::string source;          ///< begins every message about it: the file, and the place therein
};

}  // namespace ambient
