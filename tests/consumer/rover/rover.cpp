// A rover and what else is in a world, in water and wind.
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cstdio>

#include "bullet_ambient/ambient.h"
#include "preprocess/collision_shape.h"
#include "preprocess/robot.h"

void buildMyScene(btDynamicsWorld&);  // your code, unchanged

int main() {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, 0, btScalar(-9.81)});
  buildMyScene(world);
  ambient::Robot rover(ambient::readUrdf("rover.urdf"));
  rover.addTo(world);
  ambient::FluidBodyCache shapes;
  ambient::Fluid fluid(world);
  fluid.addRegion(ambient::waterBelow(0));  // still water
  fluid.addRegion(ambient::windZone({{-5, -5, 2}, {5, 5, 6}}, {8, 0, 0}));
  std::puts(fluid.addAll(shapes, ambient::air()).text().c_str());  // bodies and links
  fluid.find(rover.multiBody(), 0)->setFluidBody(ambient::loadFluidBody("fin.ambient"));
  for (int i = 0; i < 600; ++i) world.stepSimulation(btScalar(1 / 60.0), 0);
  std::printf("after 10 s the rover is at a height of %.2f m\n",
              rover.linkPose("left").translation().z());
}
