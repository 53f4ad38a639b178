#include "preprocess/collision_shape/collision_solids.h"

#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "bullet_ambient/bullet/conversions.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/collision_shape/shape_refusal.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mesh_checks.h"
#include "preprocess/mesh/weld_vertices.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Eigen::Affine3d toPose(const btTransform& transform) {
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  for (int i = 0; i < 3; ++i) {
    pose.linear().row(i) = toVector3(transform.getBasis().getRow(i));
  }
  pose.translation() = toVector3(transform.getOrigin());
  return pose;
}

/// A shape, where it is, and what begins messages about it.
struct Place {
  Eigen::Affine3d pose;
  std::string name;
  std::string part = {};  ///< "child 1: child 0" in a compound

  Place child(int i, const btTransform& transform) const {
    const std::string number = ": child " + std::to_string(i);
    return {pose * toPose(transform), name + number, (part + number).substr(part.empty() ? 2 : 0)};
  }
};

/// Turns the z axis to axis x, y or z.
Eigen::Matrix3d axisAlong(int up_axis) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) turn((up_axis + 1 + k) % 3, k) = 1;
  return turn;
}

Solid placed(Solid solid, const Eigen::Affine3d& pose) {
  for (TriangleMesh* mesh : {&solid.mesh, &solid.flow, &solid.coarse_flow, &solid.cavities}) {
    mesh->vertices = (pose.linear() * mesh->vertices).colwise() + pose.translation();
  }
  solid.margin_volume *= pose.linear().determinant();
  if (solid.added_mass) {
    const double scale = std::cbrt(pose.linear().determinant());
    const Matrix3 turn = pose.linear() / scale;
    solid.added_mass =
        shiftOrigin(rotateAxes(scaleShape(*solid.added_mass, scale), turn), -pose.translation());
  }
  return solid;
}

Solid alongAxis(const Solid& solid, int up_axis) {
  return placed(solid, Eigen::Affine3d(axisAlong(up_axis)));
}

/// Makes a mesh of triangles with corners of their own.
TriangleMesh joinTriangles(const Points& corners) {
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i + 2 < static_cast<int>(corners.size()); i += 3) {
    triangles.emplace_back(i, i + 1, i + 2);
  }
  const TriangleMesh mesh = makeTriangleMesh(corners, triangles);
  if (corners.empty()) return mesh;
  constexpr double kWeld = 1e-6;
  return weldVertices(mesh, kWeld * mesh.extents().norm());
}

void appendCorners(const btGImpactShapeInterface& part, Points& corners) {
  part.lockChildShapes();
  for (int t = 0; t < part.getNumChildShapes(); ++t) {
    btTriangleShapeEx triangle;
    part.getBulletTriangle(t, triangle);
    for (const btVector3& corner : triangle.m_vertices1) corners.push_back(toVector3(corner));
  }
  part.unlockChildShapes();
}

/// Takes the corners of all triangles of a btStridingMeshInterface, scaled.
struct CornerCollector : btInternalTriangleIndexCallback {
  Points points;

  void internalProcessTriangleIndex(btVector3* triangle, int, int) override {
    for (int k = 0; k < 3; ++k) points.push_back(toVector3(triangle[k]));
  }
};

/// Walks through a shape and collects its solids.
class SolidCollector {
 public:
  SolidCollector(bool margins, const SolidResolution& resolution)
      : margins_(margins), resolution_(resolution) {}

  void add(const btCollisionShape& shape, const Place& place) {
    switch (shape.getShapeType()) {
      case COMPOUND_SHAPE_PROXYTYPE:
        return addCompound(static_cast<const btCompoundShape&>(shape), place);
      case UNIFORM_SCALING_SHAPE_PROXYTYPE:
        return addScaled(static_cast<const btUniformScalingShape&>(shape), place);
      case GIMPACT_SHAPE_PROXYTYPE:
        return addGImpact(static_cast<const btGImpactShapeInterface&>(shape), place);
      default:
        take(makeConvex(shape, place.name), shape, place);
    }
  }

  std::vector<Solid> solids() const { return solids_; }

 private:
  void take(const Solid& solid, const btCollisionShape& shape, const Place& place) {
    solids_.push_back(placed(solid, place.pose));
    if (!place.part.empty()) solids_.back().part = place.part + " (" + shape.getName() + ")";
  }

  void addCompound(const btCompoundShape& compound, const Place& place) {
    const int count = compound.getNumChildShapes();
    if (count == 0) raiseInputError(place.name, "a compound shape without children is empty");
    for (int i = 0; i < count; ++i) {
      add(*compound.getChildShape(i), place.child(i, compound.getChildTransform(i)));
    }
  }

  void addScaled(const btUniformScalingShape& scaled, const Place& place) {
    const auto factor = static_cast<double>(scaled.getUniformScalingFactor());
    if (!(factor > 0))
      raiseInputError(place.name, "the scaling factor ", factor, " is not positive");
    add(*scaled.getChildShape(), {place.pose * Eigen::Scaling(factor), place.name, place.part});
  }

  void addGImpact(const btGImpactShapeInterface& shape, const Place& place) {
    if (shape.getGImpactShapeType() == CONST_GIMPACT_COMPOUND_SHAPE) {
      const auto& compound = static_cast<const btGImpactCompoundShape&>(shape);
      for (int i = 0; i < compound.getNumChildShapes(); ++i) {
        add(*compound.getChildShape(i), place.child(i, compound.getChildTransform(i)));
      }
      return;
    }
    Points corners;
    if (shape.getGImpactShapeType() == CONST_GIMPACT_TRIMESH_SHAPE) {
      const auto& mesh = static_cast<const btGImpactMeshShape&>(shape);
      for (int i = 0; i < mesh.getMeshPartCount(); ++i)
        appendCorners(*mesh.getMeshPart(i), corners);
    } else {
      appendCorners(shape, corners);
    }
    Solid solid;
    CheckedMesh checked = checkMesh(joinTriangles(corners), place.name);
    solid.mesh = std::move(checked.mesh);
    solid.cavities = std::move(checked.cavities);
    solid.warnings = std::move(checked.warnings);
    take(solid, shape, place);
  }

  Solid makeConvex(const btCollisionShape& shape, const std::string& name) const {
    switch (shape.getShapeType()) {
      case SPHERE_SHAPE_PROXYTYPE:
        return makeBallSolid(static_cast<const btSphereShape&>(shape).getRadius(), resolution_,
                             name);
      case BOX_SHAPE_PROXYTYPE:
        return makeBoxSolid(
            toVector3(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin()),
            resolution_, name);
      case CYLINDER_SHAPE_PROXYTYPE: {
        const auto& cylinder = static_cast<const btCylinderShape&>(shape);
        const int axis = cylinder.getUpAxis();
        const auto half_height = static_cast<double>(cylinder.getHalfExtentsWithMargin()[axis]);
        return alongAxis(
            makeCylinderSolid(cylinder.getRadius(), 2 * half_height, resolution_, name), axis);
      }
      case CAPSULE_SHAPE_PROXYTYPE: {
        const auto& capsule = static_cast<const btCapsuleShape&>(shape);
        const auto half_height = static_cast<double>(capsule.getHalfHeight());
        return alongAxis(makeCapsuleSolid(capsule.getRadius(), 2 * half_height, resolution_, name),
                         capsule.getUpAxis());
      }
      case CONE_SHAPE_PROXYTYPE: {
        const auto& cone = static_cast<const btConeShape&>(shape);
        return alongAxis(
            makeConeSolid(cone.getRadius(), cone.getHeight(), marginOf(shape), resolution_, name),
            cone.getConeUpIndex());
      }
      case MULTI_SPHERE_SHAPE_PROXYTYPE:
        return makeBallHull(static_cast<const btMultiSphereShape&>(shape), name);
      case CONVEX_HULL_SHAPE_PROXYTYPE:
      case CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE:
      case TETRAHEDRAL_SHAPE_PROXYTYPE:
        return makePolyhedron(static_cast<const btPolyhedralConvexShape&>(shape), name);
      default:
        refuseShape(shape, name);
    }
  }

  double marginOf(const btCollisionShape& shape) const {
    return margins_ ? static_cast<double>(shape.getMargin()) : 0;
  }

  Solid makeBallHull(const btMultiSphereShape& shape, const std::string& name) const {
    const Eigen::Vector3d scaling = toVector3(shape.getLocalScaling());
    std::vector<HullBall> balls;
    for (int i = 0; i < shape.getSphereCount(); ++i) {
      const auto radius = static_cast<double>(shape.getSphereRadius(i));
      balls.push_back({scaling.cwiseProduct(toVector3(shape.getSpherePosition(i))),
                       radius * scaling.cwiseAbs()});
    }
    if (balls.empty()) raiseInputError(name, "a multi-sphere shape without spheres is empty");
    return makeBallHullSolid(balls, resolution_, name);
  }

  Solid makePolyhedron(const btPolyhedralConvexShape& shape, const std::string& name) const {
    Points points;
    if (shape.getShapeType() == CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE) {
      // It knows its triangles only.
      CornerCollector corners;
      const btScalar far(BT_LARGE_FLOAT);
      static_cast<const btConvexTriangleMeshShape&>(shape)
          .getMeshInterface()
          ->InternalProcessAllTriangles(&corners, {-far, -far, -far}, {far, far, far});
      points = corners.points;
    }
    btVector3 vertex;
    for (int i = 0; i < shape.getNumVertices(); ++i) {
      shape.getVertex(i, vertex);
      points.push_back(toVector3(vertex));
    }
    return makeHullSolid(points, marginOf(shape), resolution_, name);
  }

  bool margins_;
  SolidResolution resolution_;
  std::vector<Solid> solids_;
};

int countSolids(const btCollisionShape& shape) {
  if (shape.getShapeType() != COMPOUND_SHAPE_PROXYTYPE) return 1;
  const auto& compound = static_cast<const btCompoundShape&>(shape);
  int count = 0;
  for (int i = 0; i < compound.getNumChildShapes(); ++i) {
    count += countSolids(*compound.getChildShape(i));
  }
  return count;
}

}  // namespace

std::vector<Solid> makeCollisionSolids(const btCollisionShape& shape, bool margins,
                                       const SolidResolution& resolution, const std::string& name) {
  constexpr int kLeastFaces = 350;
  const int count = std::max(1, countSolids(shape));
  SolidResolution each;
  each.faces = std::max(kLeastFaces, resolution.faces / count);
  each.flow_faces = std::max(each.faces, resolution.flow_faces / count);
  SolidCollector collector(margins, each);
  collector.add(shape, {Eigen::Affine3d::Identity(), name});
  return collector.solids();
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
