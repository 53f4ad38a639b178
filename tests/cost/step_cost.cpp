// Cost of a step with a fluid over that of stock Bullet: many equal bodies without contacts.
//
//   step_cost                                   times all scenes, both worlds in turns
//   step_cost SCENE stock|fluid BODIES STEPS    makes the steps, for a program that counts

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "preprocess/collision_shape/fluid_body_cache.h"

namespace ambient::test {
namespace {

constexpr btScalar kStep = btScalar(1) / 60;

struct Scene {
  const char* name;
  std::function<std::unique_ptr<btCollisionShape>()> shape;
  double density;  // of the bodies [kg/m^3]
  bool has_surface;
};

std::unique_ptr<btCollisionShape> box() {
  return std::make_unique<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.3), btScalar(0.4)));
}
std::unique_ptr<btCollisionShape> plate() {
  return std::make_unique<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.05), btScalar(0.4)));
}
std::unique_ptr<btCollisionShape> capsule() {
  return std::make_unique<btCapsuleShape>(btScalar(0.2), btScalar(0.6));
}
std::unique_ptr<btCollisionShape> ball() { return std::make_unique<btSphereShape>(btScalar(0.4)); }

const Scene kScenes[] = {{"boxes_under_water", box, 1000, false},
                         {"plates_under_water", plate, 1000, false},
                         {"capsules_under_water", capsule, 1000, false},
                         {"balls_under_water", ball, 1000, false},
                         {"boxes_afloat", box, 500, true},
                         {"capsules_afloat", capsule, 500, true},
                         {"balls_afloat", ball, 500, true}};

double volumeOf(const btCollisionShape& shape) {
  FluidBodyCache cache;
  return cache.fluidBody(shape)->volume;
}

// Bodies in rows, a little turned, at rest; dry until immerse().
class World {
 public:
  World(const Scene& scene, int count) : scene_(scene), shape_(scene.shape()) {
    world_.setGravity(btVector3(0, 0, btScalar(-9.81)));
    const auto mass = static_cast<btScalar>(scene.density * volumeOf(*shape_));
    btVector3 moments;
    shape_->calculateLocalInertia(mass, moments);
    for (int i = 0; i < count; ++i) addBody(i, mass, moments);
  }
  ~World() {
    fluid_.reset();
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void immerse() {
    fluid_ = std::make_unique<Fluid>(world_);
    if (scene_.has_surface) fluid_->addRegion(waterBelow(0));
    if (!fluid_->addAll(shapes_, water()).refused.empty()) std::exit(EXIT_FAILURE);
  }
  void step() { world_.stepSimulation(kStep, 0, kStep); }

 private:
  void addBody(int i, btScalar mass, const btVector3& moments) {
    bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape_.get(), moments));
    btRigidBody& body = *bodies_.back();
    const auto height = static_cast<btScalar>(scene_.has_surface ? 0.01 * (i % 7) : -50);
    const btVector3 axis = btVector3(1, btScalar(0.3), btScalar(0.2)).normalized();
    body.setWorldTransform(
        btTransform(btQuaternion(axis, btScalar(0.1) + btScalar(0.01) * btScalar(i % 11)),
                    btVector3(btScalar(4 * (i % 32)), btScalar(4 * (i / 32)), height)));
    body.setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(&body);
  }

  const Scene& scene_;
  FluidBodyCache shapes_;
  std::unique_ptr<btCollisionShape> shape_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::unique_ptr<Fluid> fluid_;
};

double secondsFor(const std::function<void()>& action) {
  const std::clock_t begin = std::clock();
  action();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Least time of a step of each world.
void timeScene(const Scene& scene) {
  constexpr int kBodies = 1000, kWarmUp = 30, kRounds = 150;
  World stock(scene, kBodies), fluid(scene, kBodies);
  const double attach = secondsFor([&] { fluid.immerse(); });
  double least[2] = {1e300, 1e300};
  for (int i = 0; i < kWarmUp + kRounds; ++i) {
    const double times[2] = {secondsFor([&] { stock.step(); }), secondsFor([&] { fluid.step(); })};
    for (int k = 0; k < 2; ++k)
      if (i >= kWarmUp) least[k] = std::min(least[k], times[k]);
  }
  std::printf("%-22s stock %.3f us, fluid %+.3f us per body and step: %.2f; attach %.1f ms\n",
              scene.name, least[0] / kBodies * 1e6, (least[1] - least[0]) / kBodies * 1e6,
              least[1] / least[0], attach * 1e3);
}

int makeSteps(const std::string& name, const std::string& kind, int bodies, int steps) {
  const auto scene = std::find_if(std::begin(kScenes), std::end(kScenes),
                                  [&](const Scene& known) { return name == known.name; });
  if (scene == std::end(kScenes) || (kind != "stock" && kind != "fluid") || bodies < 1 ||
      steps < 0) {
    std::fprintf(stderr, "step_cost: no scene '%s', or no world '%s'\n", name.c_str(),
                 kind.c_str());
    return EXIT_FAILURE;
  }
  World world(*scene, bodies);
  if (kind == "fluid") world.immerse();
  for (int i = 0; i < steps; ++i) world.step();
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace ambient::test

int main(int argc, char** argv) {
  using namespace ambient::test;
  if (argc == 5) return makeSteps(argv[1], argv[2], std::atoi(argv[3]), std::atoi(argv[4]));
  if (argc != 1) {
    std::fprintf(stderr, "usage: %s [SCENE stock|fluid BODIES STEPS]\n", argv[0]);
    return EXIT_FAILURE;
  }
  for (const Scene& scene : kScenes) timeScene(scene);
  return EXIT_SUCCESS;
}
