#include "tests/benchmark/rivals/bullet_world.h"

#include <algorithm>

namespace ambient::rivals {
namespace {

btVector3 toBullet(const Triple& v) { return {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])}; }
Triple fromBullet(const btVector3& v) { return {double(v.x()), double(v.y()), double(v.z())}; }

// An ellipsoid touches nothing here: a ball around it serves.
std::unique_ptr<btCollisionShape> shapeOf(const Solid& solid) {
  const auto a = btScalar(solid.size[0]), b = btScalar(solid.size[1]);
  switch (solid.form) {
    case Form::kBox:
      return std::make_unique<btBoxShape>(toBullet(solid.size));
    case Form::kCapsule:
      return std::make_unique<btCapsuleShape>(a, 2 * b);
    case Form::kBall:
      return std::make_unique<btSphereShape>(a);
    case Form::kEllipsoid:
      return std::make_unique<btSphereShape>(
          btScalar(*std::max_element(solid.size.begin(), solid.size.end())));
  }
  return nullptr;
}

}  // namespace

BulletWorld::BulletWorld(const Scene& scene) : scene_(scene) {
  world_.setGravity({0, 0, btScalar(-scene.gravity)});
  shapes_.push_back(shapeOf(scene.solid));
  const double mass = scene.solid.density * volumeOf(scene.solid);
  btVector3 moments;
  shapes_.front()->calculateLocalInertia(btScalar(mass), moments);
  if (scene.solid.form == Form::kEllipsoid) moments = toBullet(ellipsoidMoments(scene.solid));
  for (const Motion& start : scene.starts) addBody(start, mass, moments);
  if (!scene.room) return;
  addWall({0, 0, 1}, 0);
  for (const btScalar side : {btScalar(-1), btScalar(1)}) {
    addWall({side, 0, 0}, -*scene.room);
    addWall({0, side, 0}, -*scene.room);
  }
}

BulletWorld::~BulletWorld() {
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  for (const auto& wall : walls_) world_.removeRigidBody(wall.get());
}

void BulletWorld::addWall(const btVector3& normal, double distance) {
  shapes_.push_back(std::make_unique<btStaticPlaneShape>(normal, btScalar(distance)));
  walls_.push_back(std::make_unique<btRigidBody>(btScalar(0), nullptr, shapes_.back().get()));
  world_.addRigidBody(walls_.back().get());
}

void BulletWorld::addBody(const Motion& start, double mass, const btVector3& moments) {
  bodies_.push_back(
      std::make_unique<btRigidBody>(btScalar(mass), nullptr, shapes_.front().get(), moments));
  btRigidBody& body = *bodies_.back();
  const auto& [w, x, y, z] = start.rotation;
  body.setWorldTransform(btTransform(
      btQuaternion(btScalar(x), btScalar(y), btScalar(z), btScalar(w)), toBullet(start.position)));
  body.setLinearVelocity(toBullet(start.velocity));
  body.setAngularVelocity(toBullet(start.spin));
  body.setActivationState(DISABLE_DEACTIVATION);
  world_.addRigidBody(&body);
}

void BulletWorld::step() {
  const auto duration = btScalar(scene_.step);
  world_.stepSimulation(duration, 0, duration);
}

Motion BulletWorld::motion(std::size_t body) const {
  const btRigidBody& b = *bodies_[body];
  const btQuaternion q = b.getOrientation();
  return {fromBullet(b.getWorldTransform().getOrigin()),
          {double(q.w()), double(q.x()), double(q.y()), double(q.z())},
          fromBullet(b.getLinearVelocity()),
          fromBullet(b.getAngularVelocity())};
}

}  // namespace ambient::rivals
