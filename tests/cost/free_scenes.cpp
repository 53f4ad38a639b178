#include "tests/cost/cost_world.h"

namespace ambient::test {
namespace {

using MakeShape = std::function<std::shared_ptr<btCollisionShape>()>;

std::shared_ptr<btCollisionShape> box() {
  return std::make_shared<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.3), btScalar(0.4)));
}
std::shared_ptr<btCollisionShape> plate() {
  return std::make_shared<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.05), btScalar(0.4)));
}
std::shared_ptr<btCollisionShape> capsule() {
  return std::make_shared<btCapsuleShape>(btScalar(0.2), btScalar(0.6));
}
std::shared_ptr<btCollisionShape> ball() { return std::make_shared<btSphereShape>(btScalar(0.4)); }

// Bodies in rows, a little turned, at rest; with a surface at height 0, or far below one.
void fillRows(CostWorld& world, const MakeShape& make, bool is_afloat, int count) {
  const std::shared_ptr<btCollisionShape> shape = make();
  for (int i = 0; i < count; ++i) {
    const auto height = static_cast<btScalar>(is_afloat ? 0.01 * (i % 7) : -50);
    const btVector3 axis = btVector3(1, btScalar(0.3), btScalar(0.2)).normalized();
    const btQuaternion turned(axis, btScalar(0.1) + btScalar(0.01) * btScalar(i % 11));
    const btVector3 position(btScalar(4 * (i % 32)), btScalar(4 * (i / 32)), height);
    world.add(shape, is_afloat ? 500 : 1000, btTransform(turned, position));
  }
  world.has_surface = is_afloat;
}

}  // namespace

std::vector<CostScene> freeScenes() {
  std::vector<CostScene> scenes;
  for (const bool is_afloat : {false, true}) {
    for (const auto& [name, make] : {std::pair<std::string, MakeShape>("boxes", box),
                                     {"plates", plate},
                                     {"capsules", capsule},
                                     {"balls", ball}})
      scenes.push_back({name + (is_afloat ? "_afloat" : "_under_water"), 1000, 30,
                        [make = make, is_afloat](CostWorld& world, int count) {
                          fillRows(world, make, is_afloat, count);
                        }});
  }
  return scenes;
}

}  // namespace ambient::test
