#include "tests/bullet_ambient/bullet/water/water_run.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/motion/surface/flotation.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
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

WaterRun::WaterRun(Around around) : around_(around) {
  fluid_.world.setGravity({0, 0, bt(-kGravity)});
  if (around == Around::kWater) fluid_.fluid.addRegion(seaUnderAir());
}

WaterRun::WaterRun(std::shared_ptr<const WaterSurface> surface) : WaterRun(Around::kVacuum) {
  around_ = Around::kWater;
  FluidRegion sea = seaUnderAir();
  sea.surface = std::move(surface);
  fluid_.fluid.addRegion(sea);
}

btRigidBody& WaterRun::add(const WaterBodyDef& def) {
  FloatingBody& floating =
      bodies_.emplace_back(FloatingBody{makeWaterShape(def.shape, def.size), def.size, 0, nullptr});
  const double displaced = water().density * floating.shape.fluid_body->volume;
  floating.mass = def.specific_gravity * displaced;
  BodyDef body{floating.mass, floating.mass * floating.shape.moments};
  body.start = def.start;
  body.shape = floating.shape.collision.get();
  floating.body = &fluid_.add(body);
  const bool is_wet = around_ == Around::kWater;
  if (is_wet) attach(floating, def);
  energy_scale_ += (floating.mass + (is_wet ? displaced : 0)) * kGravity * def.size;
  return *floating.body;
}

void WaterRun::attach(const FloatingBody& floating, const WaterBodyDef& def) {
  AttachDef attach{floating.shape.fluid_body};
  attach.fluid_frame = floating.shape.fluid_frame;
  attach.flow.law = def.law;
  attach.flow.separation_angle = def.separation_angle;
  attach.flight.max_substeps = def.max_substeps;
  fluid_.fluid.add(*floating.body, attach);
}

void WaterRun::addPlane(const Vector3& normal, double height) {
  BodyDef plane;
  plane.mass = 0;
  plane.moments.setZero();
  plane.shape = &planes_.emplace_back(toBullet(normal), bt(height));
  fluid_.add(plane);
}

bool WaterRun::isDeep() const {
  return std::all_of(bodies_.begin(), bodies_.end(), [](const FloatingBody& floating) {
    return readState(*floating.body).position.z() < -5 * floating.size;
  });
}

double WaterRun::energy() const {
  double sum = 0;
  for (const FloatingBody& floating : bodies_) sum += energyOf(floating);
  return sum;
}

double WaterRun::energyOf(const FloatingBody& floating) const {
  const RigidState state = readState(*floating.body);
  const Vector6 x = state.twist.vector();
  const double weight = floating.mass * kGravity * state.position.z();
  if (around_ == Around::kVacuum) {
    const Matrix3 J = (floating.mass * floating.shape.moments).asDiagonal();
    return x.dot(rigidBodyInertia(floating.mass, J) * x) / 2 + weight;
  }
  const AmbientBody& ambient = *ambientBodiesOf(fluid_.fluid).find(floating.body);
  const SurfaceModel& model = ambient.models->surfaces.at(0).model;
  const Matrix3 R = state.orientation.toRotationMatrix();
  const SurfacePlane still{{0, 0, 1}, 0, model.excess_density, kGravity};
  const Flotation flotation = flotationAt(model, seenFrom(still, R, state.position));
  const Immersion& at = flotation.immersion_F;
  const double centre = (state.position + R * model.above.centre_of_volume).z();
  const double in_air = model.above.displaced_mass * kGravity * centre;
  return x.dot(flotation.inertia.full() * x) / 2 + weight - in_air +
         hydrostaticEnergy(at.wet, at.plane) + ambient.floating->waves.energy();
}

}  // namespace ambient::test
