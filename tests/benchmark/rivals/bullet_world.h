#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "tests/benchmark/rivals/engine.h"

namespace ambient::rivals {

/// A scene in stock Bullet, without fluid.
class BulletWorld : public World {
 public:
  explicit BulletWorld(const Scene& scene);
  ~BulletWorld() override;
  void step() override;
  Motion motion(std::size_t body) const override;

 protected:
  const Scene scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;

 private:
  void addWall(const btVector3& normal, double distance);
  void addBody(const Motion& start, double mass, const btVector3& moments);

  std::vector<std::unique_ptr<btCollisionShape>> shapes_;  ///< the bodies' first
  std::vector<std::unique_ptr<btRigidBody>> walls_;
};

}  // namespace ambient::rivals
