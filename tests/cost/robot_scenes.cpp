#include "tests/cost/cost_world.h"

namespace ambient::test {
namespace {

struct RobotKind {
  const char* name;
  int links;
  bool is_afloat = false;
  bool has_loads = true;
};

constexpr int kRobotLinks = 10;
constexpr RobotKind kKinds[] = {{"multibodies_under_water", 0},
                                {"multibodies_afloat", 0, true},
                                {"pairs_under_water", 1},
                                {"robots_in_ideal_fluid", kRobotLinks, false, false},
                                {"robots_under_water", kRobotLinks},
                                {"robots_afloat", kRobotLinks, true}};

// Robots in rows, a little turned, at rest but for their joints.
void fillRows(CostWorld& world, const RobotKind& kind, int count) {
  const auto box =
      std::make_shared<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.3), btScalar(0.4)));
  const double pitch = 4 + 1.2 * kind.links;
  for (int i = 0; i < count; ++i) {
    const auto height = static_cast<btScalar>(kind.is_afloat ? 0.01 * (i % 7) : -50);
    const btVector3 axis = btVector3(1, btScalar(0.3), btScalar(0.2)).normalized();
    const btQuaternion turned(axis, btScalar(0.1) + btScalar(0.01) * btScalar(i % 11));
    const btVector3 position(btScalar(4 * (i % 32)),
                             static_cast<btScalar>(pitch) * btScalar(i / 32), height);
    world.addRobot(box, kind.is_afloat ? 500 : 1000, kind.links, btTransform(turned, position));
  }
  world.has_surface = kind.is_afloat;
  world.has_loads = kind.has_loads;
}

}  // namespace

std::vector<CostScene> robotScenes() {
  std::vector<CostScene> scenes;
  for (const RobotKind& kind : kKinds)
    scenes.push_back({kind.name, 100, 30,
                      [&kind](CostWorld& world, int count) { fillRows(world, kind, count); },
                      true});
  return scenes;
}

}  // namespace ambient::test
