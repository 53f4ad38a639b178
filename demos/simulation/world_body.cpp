#include "demos/simulation/world_body.h"

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <utility>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/robot/link_shape.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

/// Makes a primitive of Bullet; null for a shape that is none.
struct ShapeMaker : PrimitiveMaker {
  using PrimitiveMaker::operator();
  template <class Other>
  Made operator()(const Other&) const {
    return nullptr;
  }
};

std::unique_ptr<btCollisionShape> makeHull(const Surface& surface) {
  auto hull = std::make_unique<btConvexHullShape>();
  const auto count = static_cast<Eigen::Index>(surface.vertices.size() / 3);
  const Eigen::Map<const Eigen::Matrix3Xd> points(surface.vertices.data(), 3, count);
  for (Eigen::Index i = 0; i < count; ++i) hull->addPoint(toBullet(points.col(i)), false);
  const Vector3 extents = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
  // A flat sheet has no thickness: its margin is one percent of its length.
  const double smallest = extents.minCoeff() > 0 ? extents.minCoeff() : extents.maxCoeff();
  hull->setMargin(PrimitiveMaker::margin(smallest));
  hull->recalcLocalAabb();
  return hull;
}

std::unique_ptr<btTriangleMesh> makeTriangles(const Surface& surface) {
  auto mesh = std::make_unique<btTriangleMesh>();
  const auto corner = [&](std::size_t i) {
    return toBullet(Eigen::Map<const Vector3>(&surface.vertices[3 * surface.triangles[i]]));
  };
  for (std::size_t i = 0; i + 2 < surface.triangles.size(); i += 3)
    mesh->addTriangle(corner(i), corner(i + 1), corner(i + 2));
  return mesh;
}

/// Makes each part as one of Bullet's primitives, or as the hull of its mesh.
CollisionShape makeCompoundShape(const Compound& compound, const btTransform& S_in_B) {
  constexpr int kHullFaces = 320;
  CollisionShape shape;
  auto whole = std::make_unique<btCompoundShape>();
  for (const PlacedShape& part : compound.parts) {
    if (auto primitive = std::visit(ShapeMaker{}, part.shape))
      shape.parts.push_back(std::move(primitive));
    else
      shape.parts.push_back(makeHull(surfaceOf(factsOf(part.shape).mesh(kHullFaces))));
    const btTransform pose(toBullet(Quaternion(part.pose.linear())),
                           toBullet(Vector3(part.pose.translation())));
    whole->addChildShape(S_in_B * pose, shape.parts.back().get());
  }
  shape.parts.push_back(std::move(whole));
  return shape;
}

bool isIdentity(const btTransform& transform) {
  return transform.getOrigin().isZero() && transform.getBasis() == btMatrix3x3::getIdentity();
}

MotionSample startOf(const BodyDef& def) {
  MotionSample start;
  start.position = def.position;
  start.orientation = def.orientation;
  start.twist = {def.angular_velocity, def.linear_velocity};
  return start;
}

btTransform toBulletPose(const Matrix3& rotation, const Vector3& translation) {
  return btTransform(toBulletMatrix(rotation), toBullet(translation));
}

}  // namespace

WorldBody makeWorldBody(const BodyDef& def, const PreparedBody& prepared) {
  WorldBody made;
  made.name = def.name;
  made.fluid_body = prepared.fluid_body;
  made.start = startOf(def);
  PrincipalFrame principal;
  if (prepared.mass > 0) principal = findPrincipalFrame(prepared.inertia);
  made.R_SB = principal.rotation;
  const Matrix3 R_BS = made.R_SB.transpose();
  made.to_B = Quaternion(R_BS);
  made.shape = makeCollisionShape(def, prepared,
                                  toBulletPose(R_BS, Vector3(R_BS * -prepared.centre_of_mass)));

  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(prepared.mass), nullptr,
                                                made.shape.root(), toBullet(principal.moments));
  info.m_startWorldTransform =
      toBulletPose(Matrix3(def.orientation.toRotationMatrix() * made.R_SB), def.position);
  info.m_restitution = static_cast<btScalar>(def.restitution);
  info.m_friction = static_cast<btScalar>(def.friction);
  made.body = std::make_unique<btRigidBody>(info);
  made.body->setLinearVelocity(toBullet(def.linear_velocity));
  made.body->setAngularVelocity(toBullet(def.angular_velocity));
  // Bullet would put a body that hovers or glides slowly to sleep.
  made.body->setActivationState(DISABLE_DEACTIVATION);
  return made;
}

WorldBody makeWorldLink(const BodyDef& def, const PreparedBody& prepared, const Matrix3& R_SB) {
  WorldBody made;
  made.name = def.name;
  made.link = def.link;
  made.fluid_body = prepared.fluid_body;
  made.start = startOf(def);
  made.R_SB = R_SB;
  return made;
}

BulletWorld makeBulletWorld(bool takes_robots, btCollisionDispatcher& dispatcher,
                            btBroadphaseInterface& broadphase,
                            btCollisionConfiguration& configuration) {
  BulletWorld made;
  if (takes_robots) {
    auto solver = std::make_unique<btMultiBodyConstraintSolver>();
    auto world = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher, &broadphase, solver.get(),
                                                            &configuration);
    made.multi_body_world = world.get();
    made.solver = std::move(solver);
    made.world = std::move(world);
  } else {
    auto solver = std::make_unique<btSequentialImpulseConstraintSolver>();
    made.world = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, solver.get(),
                                                           &configuration);
    made.solver = std::move(solver);
  }
  // Contacts, and so their rounding, then depend on the state alone and not on its history.
  made.world->getDispatchInfo().m_deterministicOverlappingPairs = true;
  return made;
}

CollisionShape makeCollisionShape(const BodyDef& def, const PreparedBody& prepared,
                                  const btTransform& S_in_B) {
  if (const auto* compound = std::get_if<Compound>(&def.shape.geometry))
    return makeCompoundShape(*compound, S_in_B);
  CollisionShape shape;
  if (auto primitive = std::visit(ShapeMaker{}, def.shape.geometry)) {
    shape.parts.push_back(std::move(primitive));
  } else if (prepared.mass > 0) {
    shape.parts.push_back(makeHull(prepared.surface));
  } else {
    shape.triangles = makeTriangles(prepared.surface);
    shape.parts.push_back(std::make_unique<btBvhTriangleMeshShape>(shape.triangles.get(), true));
  }
  // Bullet adds contacts of plain shapes at gaps below its threshold of 2 cm, and a bounce loses
  // the remaining gap. For children of compounds Bullet waits until their boxes meet.
  if (prepared.mass == 0 && isIdentity(S_in_B)) return shape;
  auto compound = std::make_unique<btCompoundShape>();
  compound->addChildShape(S_in_B, shape.parts.back().get());
  shape.parts.push_back(std::move(compound));
  return shape;
}

}  // namespace ambient
