#include "tests/bullet_ambient/bullet/water/water_shapes.h"

#include <array>
#include <optional>
#include <utility>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

constexpr double kMargin = 0.01;  // hull of 1 m [m]

std::unique_ptr<btCollisionShape> makeHull(double size) {
  Arbitrary arbitrary(7);
  auto hull = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < 14; ++i) {
    const Vector3 point = arbitrary.vector().normalized().cwiseProduct(Vector3(0.5, 0.4, 0.3));
    hull->addPoint(toBullet(Vector3(size * point)));
  }
  hull->setMargin(bt(kMargin * size));
  return hull;
}

std::unique_ptr<btCollisionShape> makeBar(const Vector3& half_size) {
  return std::make_unique<btBoxShape>(toBullet(half_size));
}

// Makes a collision shape in the shape's own frame.
SizedShape makeCollisionShape(WaterShape shape, double size) {
  SizedShape made;
  made.collision = std::make_unique<btCompoundShape>();
  btVector3 second(0, 0, 0);
  switch (shape) {
    case WaterShape::kBall:
      made.parts[0] = std::make_unique<btSphereShape>(bt(size / 2));
      break;
    case WaterShape::kBox:
      made.parts[0] = makeBar(size * Vector3(0.5, 0.35, 0.225));
      break;
    case WaterShape::kCube:
      made.parts[0] = makeBar(size * Vector3::Constant(0.5));
      break;
    case WaterShape::kHull:
      made.parts[0] = makeHull(size);
      break;
    case WaterShape::kAngle:
      made.parts[0] = makeBar(size * Vector3(0.5, 0.15, 0.15));
      made.parts[1] = makeBar(size * Vector3(0.15, 0.35, 0.15));
      second = btVector3(bt(0.35 * size), bt(0.3 * size), 0);
      break;
  }
  btTransform pose = btTransform::getIdentity();
  for (const auto& part : made.parts) {
    if (part) made.collision->addChildShape(pose, part.get());
    pose.setOrigin(second);
  }
  return made;
}

// Fluid body of size 1, solved once per shape.
const FluidBody& unitBody(WaterShape shape) {
  static std::array<std::optional<FluidBody>, kWaterShapes> bodies;
  std::optional<FluidBody>& body = bodies.at(static_cast<std::size_t>(shape));
  if (!body) {
    const SizedShape unit = makeCollisionShape(shape, 1);
    CollisionShapeSettings settings;
    settings.name = "floating";
    settings.faces = 400;
    settings.flow.max_panels = 300;
    settings.report = nullptr;
    const bool has_one_part = unit.collision->getNumChildShapes() == 1;
    body = makeFluidBody(has_one_part ? *unit.parts[0] : *unit.collision, settings);
  }
  return *body;
}

}  // namespace

SizedShape makeWaterShape(WaterShape shape, double size) {
  SizedShape made = makeCollisionShape(shape, size);
  auto body = std::make_shared<FluidBody>(scaled(unitBody(shape), size));
  const MassDistribution& mass = body->uniform_mass;
  const PrincipalFrame principal = findPrincipalFrame(mass.inertia);
  made.moments = principal.moments;
  made.fluid_frame.rotation = principal.rotation.transpose();
  made.fluid_frame.translation = -(made.fluid_frame.rotation * mass.centre);
  const btTransform frame(toBullet(Quaternion(made.fluid_frame.rotation)),
                          toBullet(made.fluid_frame.translation));
  for (int i = 0; i < made.collision->getNumChildShapes(); ++i)
    made.collision->updateChildTransform(i, frame * made.collision->getChildTransform(i), false);
  made.collision->recalculateLocalAabb();
  made.fluid_body = std::move(body);
  return made;
}

}  // namespace ambient::test
