#include <btBulletDynamicsCommon.h>

// Ten crates in the air above the water, as a scene has them that knows no fluid. They live as long
// as the program.
void buildMyScene(btDynamicsWorld& world) {
  static btBoxShape crate({btScalar(0.2), btScalar(0.2), btScalar(0.2)});
  btVector3 inertia;
  crate.calculateLocalInertia(32, inertia);
  for (int i = 0; i < 10; ++i) {
    auto* body = new btRigidBody(32, nullptr, &crate, inertia);
    body->translate({btScalar(i - 5), 3, 4});
    world.addRigidBody(body);
  }
}
