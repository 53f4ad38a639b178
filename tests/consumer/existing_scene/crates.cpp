// An ordinary Bullet scene, the start of docs/tutorial.md: 27 wooden crates in a stack, and a heavy
// ball that falls onto them.
#include <btBulletDynamicsCommon.h>

#include <cstdio>

int main() {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, 0, -9.81f});

  const auto add = [&world](btCollisionShape& shape, btScalar mass, const btVector3& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    auto* body = new btRigidBody(mass, nullptr, &shape, inertia);
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
    world.addRigidBody(body);
    return body;
  };

  btStaticPlaneShape ground({0, 0, 1}, 0);
  btBoxShape crate({0.2f, 0.2f, 0.2f});
  btSphereShape ball(0.2f);
  add(ground, 0, {0, 0, 0});
  btRigidBody* crates[27];
  for (int i = 0; i < 27; ++i)
    crates[i] = add(crate, 38, {0.5f * (i % 3), 0.5f * (i / 3 % 3), 0.2f + 0.4f * (i / 9)});
  btRigidBody* falling = add(ball, 260, {0.6f, 0.4f, 4});

  std::printf("time [s]  crates, mean height [m]  ball [m]\n");
  for (int step = 0; step <= 600; ++step) {
    if (step % 60 == 0) {
      btScalar height = 0;
      for (const btRigidBody* body : crates)
        height += body->getWorldTransform().getOrigin().z() / 27;
      std::printf("%8d  %23.2f  %8.2f\n", step / 60, height,
                  falling->getWorldTransform().getOrigin().z());
    }
    world.stepSimulation(btScalar(1) / 60, 1, btScalar(1) / 60);
  }

  while (world.getNumCollisionObjects() > 0) {
    btCollisionObject* object = world.getCollisionObjectArray()[0];
    world.removeCollisionObject(object);
    delete object;
  }
}
