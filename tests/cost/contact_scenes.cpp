#include <array>
#include <cmath>

#include "tests/cost/cost_world.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

constexpr double kDensity = 2500;  // of all bodies [kg/m^3]: they sink

btVector3 vectorOf(double x, double y, double z) {
  return {static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)};
}

void addPlane(CostWorld& world, const btVector3& normal, double distance) {
  world.add(std::make_shared<btStaticPlaneShape>(normal, static_cast<btScalar>(distance)), 0,
            btTransform::getIdentity());
}

std::shared_ptr<btCollisionShape> cube(double half_edge) {
  return std::make_shared<btBoxShape>(vectorOf(half_edge, half_edge, half_edge));
}

// A cube of cubes, a little turned, on a floor between four walls.
void fillPile(CostWorld& world, int count) {
  const double size = 0.1;
  const int edge = static_cast<int>(std::lround(std::cbrt(count)));
  for (const double side : {-1, 1}) {
    addPlane(world, vectorOf(side, 0, 0), -(1.5 * edge + 2) * size);
    addPlane(world, vectorOf(0, side, 0), -(1.5 * edge + 2) * size);
  }
  addPlane(world, vectorOf(0, 0, 1), 0);
  Arbitrary arbitrary(1);
  const std::shared_ptr<btCollisionShape> box = cube(size);
  for (int i = 0; i < edge * edge * edge; ++i) {
    const Vector3 turn = arbitrary.vector(0.001);
    const btQuaternion turned(static_cast<btScalar>(turn.x()), static_cast<btScalar>(turn.y()),
                              static_cast<btScalar>(turn.z()), 1);
    const btVector3 position = vectorOf(2 * size * (i % edge - (edge - 1) / 2.0),
                                        2 * size * (i / edge % edge - (edge - 1) / 2.0),
                                        size * (2 * (i / edge / edge) + 1));
    world.add(box, kDensity, btTransform(turned.normalized(), position));
  }
  world.duration = 1.0 / 240;
}

// Cubes side by side that fall a short way onto a large box, as in Bullet's basic example.
void fillBlock(CostWorld& world, int count) {
  const double size = 0.1;
  const int edge = static_cast<int>(std::lround(std::cbrt(count)));
  world.add(cube(50), 0, btTransform(btQuaternion::getIdentity(), vectorOf(0, 0, -50)));
  const std::shared_ptr<btCollisionShape> box = cube(size);
  for (int i = 0; i < edge * edge * edge; ++i)
    world.add(
        box, kDensity,
        btTransform(btQuaternion::getIdentity(),
                    static_cast<btScalar>(size) * vectorOf(2 * (i % edge), 2 * (i / edge % edge),
                                                           2 * (i / edge / edge) + 1.5)));
}

// Pyramids, walls and round towers of cubes of 2 m, as in Bullet's benchmark of stacks.
void fillStacks(CostWorld& world, int count) {
  addPlane(world, vectorOf(0, 0, 1), 0);
  const std::shared_ptr<btCollisionShape> box = cube(0.96);
  int left = count;
  const auto addBox = [&](const btVector3& position, double turn) {
    if (left-- > 0)
      world.add(
          box, kDensity,
          btTransform(btQuaternion(vectorOf(0, 0, 1), static_cast<btScalar>(turn)), position));
  };
  const double pi = std::acos(-1.0);
  for (double east = 0; left > 0; east += 60) {
    for (int layer = 0; layer < 6; ++layer)  // pyramid
      for (int i = 0; i < (6 - layer) * (6 - layer); ++i)
        addBox(vectorOf(east + 2.04 * (i % (6 - layer)) + 1.02 * layer,
                        2.04 * (i / (6 - layer)) + 1.02 * layer, 1 + 2 * layer),
               0);
    for (int layer = 0; layer < 8; ++layer)  // wall
      for (int i = 0; i < 8 - layer; ++i)
        addBox(vectorOf(east + 20, 2 * i + layer, 1 + 2 * layer), 0);
    for (int layer = 0; layer < 6; ++layer) {  // tower
      for (int i = 0; i < 16; ++i) {
        const double angle = 2 * pi * (i + 0.5 * layer) / 16;
        addBox(vectorOf(east + 40 + 6.6 * std::cos(angle), 6.6 * std::sin(angle), 1 + 2 * layer),
               angle);
      }
    }
  }
}

// A limb hangs from its parent: a capsule along z.
struct Limb {
  int parent;  // -1: the first one
  double radius, length;
  double x, z;    // middle [m]
  double joint;   // height of the joint [m]
  bool is_hinge;  // else a cone
};

constexpr std::array<Limb, 11> kFigure = {{{-1, 0.15, 0.22, 0, 1.00, 0, false},
                                           {0, 0.15, 0.22, 0, 1.32, 1.15, true},
                                           {1, 0.10, 0.08, 0, 1.68, 1.57, false},
                                           {0, 0.07, 0.38, -0.2, 0.62, 0.88, false},
                                           {3, 0.07, 0.38, -0.2, 0.22, 0.40, true},
                                           {0, 0.07, 0.38, 0.2, 0.62, 0.88, false},
                                           {5, 0.07, 0.38, 0.2, 0.22, 0.40, true},
                                           {1, 0.05, 0.27, -0.3, 1.25, 1.42, false},
                                           {7, 0.05, 0.27, -0.3, 0.92, 1.08, true},
                                           {1, 0.05, 0.27, 0.3, 1.25, 1.42, false},
                                           {9, 0.05, 0.27, 0.3, 0.92, 1.08, true}}};

btTransform frameAt(const btRigidBody& body, const btVector3& point, const btQuaternion& axes) {
  return body.getWorldTransform().inverse() * btTransform(axes, point);
}

void join(CostWorld& world, const Limb& limb, btRigidBody& parent, btRigidBody& body, double east) {
  const btScalar quarter = SIMD_HALF_PI;
  const btVector3 point = vectorOf(east + limb.x, 0, limb.joint);
  if (limb.is_hinge) {  // about x
    const btQuaternion axes(vectorOf(0, 1, 0), quarter);
    auto hinge = std::make_unique<btHingeConstraint>(parent, body, frameAt(parent, point, axes),
                                                     frameAt(body, point, axes));
    hinge->setLimit(0, quarter);
    world.addJoint(std::move(hinge));
  } else {
    const btQuaternion axes(vectorOf(0, 1, 0), -quarter);
    auto cone = std::make_unique<btConeTwistConstraint>(parent, body, frameAt(parent, point, axes),
                                                        frameAt(body, point, axes));
    cone->setLimit(SIMD_HALF_PI / 2, SIMD_HALF_PI / 2, SIMD_HALF_PI / 2);
    world.addJoint(std::move(cone));
  }
}

// Figures of eleven limbs fall onto a floor, as in Bullet's benchmark of ragdolls.
void fillFigures(CostWorld& world, int count) {
  addPlane(world, vectorOf(0, 0, 1), 0);
  std::vector<std::shared_ptr<btCollisionShape>> shapes;
  for (const Limb& limb : kFigure)
    shapes.push_back(std::make_shared<btCapsuleShapeZ>(static_cast<btScalar>(limb.radius),
                                                       static_cast<btScalar>(limb.length)));
  for (int figure = 0; figure < count / static_cast<int>(kFigure.size()); ++figure) {
    const double east = 1.2 * figure;
    std::vector<btRigidBody*> bodies;
    for (std::size_t i = 0; i < kFigure.size(); ++i) {
      const Limb& limb = kFigure[i];
      btRigidBody& body =
          world.add(shapes[i], kDensity,
                    btTransform(btQuaternion::getIdentity(), vectorOf(east + limb.x, 0, limb.z)));
      body.setDamping(btScalar(0.05), btScalar(0.85));
      if (limb.parent >= 0) join(world, limb, *bodies[limb.parent], body, east);
      bodies.push_back(&body);
    }
  }
}

}  // namespace

std::vector<CostScene> contactScenes() {
  return {{"pile_in_water", 512, 240, fillPile},
          {"block_in_water", 125, 120, fillBlock},
          {"stacks_in_water", 446, 120, fillStacks},
          {"figures_in_water", 176, 120, fillFigures}};
}

}  // namespace ambient::test
