// Two balls of half the density of water on a bar with a joint, released at rest deep under water:
// dumbbell FILE.urdf
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <exception>

#include "bullet_ambient/ambient.h"
#include "preprocess/collision_shape.h"
#include "preprocess/robot.h"

namespace {

constexpr btScalar kGravity = btScalar(9.81);
constexpr int kSteps = 120;
constexpr double kTimeStep = 1.0 / 240;

/// Returns the rise of the right ball [m] after half a second.
double riseInWater(const char* file) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;

  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, 0, -kGravity});
  ambient::Fluid fluid(world);

  ambient::Robot robot(ambient::readUrdf(file));
  robot.addTo(world);
  ambient::FluidBodyCache shapes;
  ambient::AttachDef def;
  def.medium = ambient::water();
  ambient::attachRobot(fluid, robot, shapes, def);

  for (int step = 0; step < kSteps; ++step) {
    robot.prepareStep(kTimeStep);
    world.stepSimulation(btScalar(kTimeStep), 0);
  }
  fluid.clear();
  return robot.linkPose("right").translation().z();
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: dumbbell FILE.urdf\n");
    return 2;
  }
  const double rise = riseInWater(argv[1]);
  std::printf("It rose by %.4f m, Bullet's numbers have %zu bytes.\n", rise, sizeof(btScalar));
  // Initial acceleration is g / 2, (m_f - m) / (m + m_f / 2) with the added mass; drag lowers it.
  // Without added mass the bound would be g; without fluid the ball would sink.
  const double time = kSteps * kTimeStep;
  return rise > 0 && rise < kGravity / 4 * time * time ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
