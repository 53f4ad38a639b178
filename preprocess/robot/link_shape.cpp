#include "preprocess/robot/link_shape.h"

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/shapes/convex_hull.h"

AMBIENT_BEGIN

namespace {

/// Bullet's shape of a part, in its own frame.
struct PartMaker : PrimitiveMaker {
  const std::string& source;

  explicit PartMaker(const std::string& of) : source(of) {}
  using PrimitiveMaker::operator();
  Made operator()(const Ellipsoid& s) const {
    const btVector3 centre(0, 0, 0);
    const btScalar radius = 1;
    auto ball = std::make_unique<btMultiSphereShape>(&centre, &radius, 1);
    ball->setLocalScaling(toBullet(s.semi_axes));
    return withMargin(std::move(ball), s.semi_axes.minCoeff());
  }
  template <class Other>
  Made operator()(const Other&) const {
    raiseInputError(source, "this kind of shape cannot be a part of a link");
  }
};

// Convex hull of an object of a mesh file, stretched as the file [m].
std::unique_ptr<btConvexHullShape> hullOf(const TriangleMesh& object, const std::string& source,
                                          const MeshFile& file) {
  const double least = object.extents().minCoeff();
  if (!(least > 0))
    raiseInputError(source, "the mesh ", file.file.string(),
                    " is flat; the convex hull of a mesh must have a volume");
  auto hull = std::make_unique<btConvexHullShape>();
  for (Eigen::Index i = 0; i < object.vertexCount(); ++i)
    hull->addPoint(toBullet(Vector3(object.vertices.col(i))), false);
  hull->setMargin(0);
  hull->optimizeConvexHull();
  hull->setMargin(PrimitiveMaker::margin(least / 2));
  return hull;
}

// True if closed parts make up the mesh, which may touch: triangles run along each edge as often in
// one direction as in the other.
bool isWithoutBorder(const TriangleMesh& mesh) {
  const MeshEdges edges = computeMeshEdges(mesh);
  return std::all_of(edges.edges.begin(), edges.edges.end(), [&](const EdgeGroup& edge) {
    std::size_t forward = 0;
    for (std::size_t i = edge.first; i < edge.last; ++i) forward += edges.half_edges[i].forward;
    return 2 * forward == edge.size();
  });
}

// Says that a hull is much larger than the closed mesh that it stands for; none if it is not.
std::optional<std::string> largerHull(const TriangleMesh& object, const MeshFile& file) {
  constexpr double kMuchLarger = 1.5;
  const TriangleMesh mesh = weldVertices(object, kWeldTolerance * object.extents().norm());
  if (!isWithoutBorder(mesh)) return std::nullopt;
  const std::string name = file.file.string();
  const Eigen::Vector3d middle = mesh.bounds().center();
  const TriangleMesh hull = makeConvexHull(mesh.vertices, name, kCoarseHullBits);
  const double ratio = tetrahedraVolume(hull, middle) / std::abs(tetrahedraVolume(mesh, middle));
  if (!(ratio > kMuchLarger)) return std::nullopt;
  std::ostringstream text;
  text.precision(2);
  text << name << ": its convex hull, which collides and is in the fluid, has " << ratio
       << " times its volume, and no holds: give the link a fluid body of its own";
  return text.str();
}

}  // namespace

LinkShape makeLinkShape(const LinkModel& link, const RigidPose& link_in_body) {
  LinkShape made;
  made.in_body = std::make_unique<btCompoundShape>();
  made.in_link = std::make_unique<btCompoundShape>();
  const auto add = [&](std::unique_ptr<btCollisionShape> shape, const RigidPose& pose) {
    made.in_link->addChildShape(toBulletTransform(pose), shape.get());
    made.in_body->addChildShape(toBulletTransform(link_in_body * pose), shape.get());
    made.parts.push_back(std::move(shape));
  };
  const bool has_own_body = link.fluid && !link.fluid->fluid_body.empty();
  for (const PlacedShape& part : link.collisions) {
    const auto* file = std::get_if<MeshFile>(&part.shape);
    if (!file) {
      add(std::visit(PartMaker(part.name), part.shape), part.pose);
      continue;
    }
    for (TriangleMesh& object : importObjects(file->file)) {
      object.vertices = file->stretch.asDiagonal() * object.vertices;
      add(hullOf(object, part.name, *file), part.pose);
      const auto warning = has_own_body ? std::nullopt : largerHull(object, *file);
      if (warning) made.warnings.push_back(part.name + ": " + *warning);
    }
  }
  return made;
}

LinkMassFrame findMassFrame(const LinkModel& link) {
  LinkMassFrame frame;
  const PrincipalFrame principal =
      link.inertia.isZero(0) ? PrincipalFrame{} : findPrincipalFrame(link.inertia);
  frame.moments = principal.moments;
  frame.link_in_body.linear() = principal.rotation.transpose();
  frame.link_in_body.translation() = principal.rotation.transpose() * -link.centre_of_mass;
  return frame;
}

btTransform toBulletTransform(const RigidPose& pose) {
  return btTransform(toBulletMatrix(pose.linear()), toBullet(Vector3(pose.translation())));
}

RigidPose toPose(const btTransform& transform) {
  RigidPose pose = RigidPose::Identity();
  pose.linear() = toQuaternion(transform.getRotation()).toRotationMatrix();
  pose.translation() = toVector3(transform.getOrigin());
  return pose;
}

AMBIENT_END
