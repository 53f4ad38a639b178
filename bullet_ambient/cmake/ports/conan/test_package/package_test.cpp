// Gives a world a fluid; fails if the world's solver is not the fluid's.
#include <btBulletDynamicsCommon.h>

#include <cstdio>

#include "bullet_ambient/ambient.h"

int main() {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  const ambient::Fluid fluid(world);
  world.stepSimulation(btScalar(1) / 240, 0);
  std::printf("Bullet %d with a fluid of density %g kg/m^3\n", btGetVersion(),
              ambient::water().density);
  return world.getConstraintSolver() == &solver ? 1 : 0;
}
