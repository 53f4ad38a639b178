// A ball of half the density of water, released at rest deep under its surface: cork FILE.ambient
#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <exception>

#include "bullet_ambient/ambient.h"

namespace {

constexpr btScalar kGravity = btScalar(9.81);
constexpr int kSteps = 120;
constexpr btScalar kTimeStep = btScalar(1) / 240;

/// Returns the rise of the ball [m] after half a second; negative if its saved state does not bring
/// it back.
btScalar riseInWater(const char* file) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;

  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, 0, -kGravity});
  ambient::Fluid fluid(world);

  const ambient::AttachDef def{ambient::loadFluidBody(file), ambient::water()};
  const btScalar mass = btScalar(0.5 * def.medium.density * def.fluid_body->volume);
  btSphereShape shape(btScalar(0.05));
  btVector3 inertia;
  shape.calculateLocalInertia(mass, inertia);
  btRigidBody ball(mass, nullptr, &shape, inertia);
  world.addRigidBody(&ball);
  fluid.add(ball, def);

  const ambient::WorldState start = fluid.save();
  for (int step = 0; step < kSteps; ++step) world.stepSimulation(kTimeStep, 0, kTimeStep);
  const btScalar rise = ball.getWorldTransform().getOrigin().z();
  fluid.restore(start);
  const bool is_back = ball.getWorldTransform().getOrigin().isZero();

  world.removeRigidBody(&ball);
  return is_back ? rise : -1;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: cork FILE.ambient\n");
    return 2;
  }
  const btScalar rise = riseInWater(argv[1]);
  std::printf("The ball rose by %.4f m, Bullet's numbers have %zu bytes.\n", double(rise),
              sizeof(btScalar));
  // Initial acceleration is g / 2, (m_f - m) / (m + m_f / 2) with the added mass; drag lowers it.
  // Without added mass the bound would be g; without fluid the ball would sink.
  const btScalar time = kSteps * kTimeStep;
  return rise > 0 && rise < kGravity / 4 * time * time ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
