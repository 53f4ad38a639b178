// Cost of a robot's step in a fluid over that of stock Bullet: minimum of many blocks of steps,
// taken in turns. docs/robots.md has the table.
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <vector>

#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::test {
namespace {

constexpr int kBlocks = 60, kSteps = 100;
constexpr double kStep = 1.0 / 240;

enum class Around { kNothing, kIdealFluid, kWater };

class Robot {
 public:
  Robot(int links, bool has_motors, Around around)
      : world_(around == Around::kNothing ? std::make_unique<btMultiBodyConstraintSolver>()
                                          : nullptr) {
    Arbitrary arbitrary(2);
    RobotDef def;
    def.links = links;
    def.speed = 0.3;
    def.collider_radius = 0.01;
    btMultiBody& body = world_.add(arbitrary, def);
    if (around == Around::kIdealFluid) putIntoFluid(arbitrary, world_, body, 2);
    if (around == Around::kWater) {
      AttachDef attach;
      attach.medium = water();
      attach.fluid_body =
          std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.15, 0.08, 0.05), 1));
      for (int link = -1; link < links; ++link) world_.fluid.add(body, link, attach);
    }
    for (int link = 0; has_motors && link < links; ++link)
      world_.take(std::make_unique<btMultiBodyJointMotor>(&body, link, btScalar(0.1), btScalar(1)));
  }

  void time() {
    const auto begin = std::chrono::steady_clock::now();
    world_.step(kStep, kSteps);
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - begin;
    least_ = std::min(least_, taken.count() / kSteps);
  }
  double microseconds() const { return least_; }

 private:
  RobotWorld world_;
  double least_ = std::numeric_limits<double>::infinity();
};

void compare(int links, bool has_motors) {
  std::vector<std::unique_ptr<Robot>> robots;
  for (const Around around : {Around::kNothing, Around::kIdealFluid, Around::kWater})
    robots.push_back(std::make_unique<Robot>(links, has_motors, around));
  for (int i = 0; i < kBlocks; ++i)
    for (const auto& robot : robots) robot->time();
  const double stock = robots[0]->microseconds();
  std::printf("| %d | %s | %.1f | %.2f | %.2f |\n", links, has_motors ? "yes" : "no", stock,
              robots[1]->microseconds() / stock, robots[2]->microseconds() / stock);
}

}  // namespace
}  // namespace ambient::test

int main() {
  std::puts("| links | motors | stock [us] | ideal fluid | water, 80 faces a link |");
  std::puts("|---|---|---|---|---|");
  for (const bool has_motors : {false, true})
    for (const int links : {3, 10, 30}) ambient::test::compare(links, has_motors);
}
