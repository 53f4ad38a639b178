#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <variant>

namespace ambient {

// Shapes in their own frame S, lengths in metres. Solids are centred at the origin, round ones have
// their axis along z; sheets lie in the x-y plane with normal +z.

struct SphereShape {
  double radius = 0;
};
struct BoxShape {
  Eigen::Vector3d half_sizes = Eigen::Vector3d::Zero();
};
struct EllipsoidShape {
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Zero();
};
struct CylinderShape {
  double radius = 0;
  double height = 0;
};
struct CapsuleShape {
  double radius = 0;
  double height = 0;  ///< of the cylindrical part
};
struct ConeShape {
  double radius = 0;
  double height = 0;  ///< apex at +height/2
};
/// What stands for the triangles of a file.
enum class MeshStandIn { kNone, kHull, kWrap };
struct MeshShape {
  std::filesystem::path file;
  double scale = 1;
  MeshStandIn stand_in = MeshStandIn::kNone;
  double wrap_size = 0;  ///< with kWrap, before any scaling [m]; 0: kDefaultWrapSize
};
struct FluidBodyShape {
  std::filesystem::path file;
};
struct RectangularSheetShape {
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
};
struct EllipticSheetShape {
  Eigen::Vector2d semi_axes = Eigen::Vector2d::Zero();
};
struct MeshSheetShape {
  std::filesystem::path file;
  double scale = 1;
};

/// One shape of data/schema/shape.schema.json.
struct ShapeDescription {
  static constexpr int kDefaultFaces = 1300;

  std::variant<SphereShape, BoxShape, EllipsoidShape, CylinderShape, CapsuleShape, ConeShape,
               MeshShape, FluidBodyShape, RectangularSheetShape, EllipticSheetShape, MeshSheetShape>
      geometry;
  int faces = kDefaultFaces;  ///< triangles aimed at, where the shape has no mesh of its own
  std::string text;           ///< the description, as JSON on one line
  std::string source;         ///< begins every message about it: the file, and the place therein
};

}  // namespace ambient
