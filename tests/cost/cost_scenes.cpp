#include <array>
#include <cmath>
#include <filesystem>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/reduced_loads/form_levels.h"
#include "tests/cost/cost_world.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/bodies/vessel_bodies.h"

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
  double east = 0;
  while (left > 0) {
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
    east += 60;
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

namespace {

using MakeShape = std::function<std::shared_ptr<btCollisionShape>(btScalar stretch)>;

std::shared_ptr<btCollisionShape> box(btScalar stretch) {
  return std::make_shared<btBoxShape>(
      btVector3(btScalar(0.5), btScalar(0.3), btScalar(0.4) * stretch));
}
std::shared_ptr<btCollisionShape> plate(btScalar stretch) {
  return std::make_shared<btBoxShape>(
      btVector3(btScalar(0.5), btScalar(0.05), btScalar(0.4) * stretch));
}
std::shared_ptr<btCollisionShape> capsule(btScalar stretch) {
  return std::make_shared<btCapsuleShape>(btScalar(0.2), btScalar(0.6) * stretch);
}
std::shared_ptr<btCollisionShape> cylinder(btScalar stretch) {
  return std::make_shared<btCylinderShape>(
      btVector3(btScalar(0.3), btScalar(0.4) * stretch, btScalar(0.3)));
}
std::shared_ptr<btCollisionShape> cone(btScalar stretch) {
  return std::make_shared<btConeShape>(btScalar(0.4), btScalar(0.8) * stretch);
}
std::shared_ptr<btCollisionShape> ball(btScalar stretch) {
  return std::make_shared<btSphereShape>(btScalar(0.4) * stretch);
}

struct Rows {
  MakeShape make;
  bool is_afloat;
  bool differ = false;  ///< no two shapes are as long
};

// From 2/3 to 4/3, evenly spread and without repetition.
double stretchOf(int i) {
  constexpr double kGolden = 0.6180339887498949;
  return 2.0 / 3 * (1 + std::fmod(kGolden * i, 1.0));
}

// Bodies in rows, a little turned, at rest; with a surface at height 0, or far below one.
void fillRows(CostWorld& world, const Rows& rows, int count) {
  const bool is_afloat = rows.is_afloat;
  std::shared_ptr<btCollisionShape> shape = rows.make(1);
  for (int i = 0; i < count; ++i) {
    if (rows.differ) shape = rows.make(static_cast<btScalar>(stretchOf(i)));
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
                          fillRows(world, {make, is_afloat}, count);
                        }});
  }
  return scenes;
}

std::vector<CostScene> differentScenes() {
  std::vector<CostScene> scenes;
  for (const int bodies : {300, 1000})
    for (const auto& [name, make] : {std::pair<std::string, MakeShape>("boxes", box),
                                     {"capsules", capsule},
                                     {"cylinders", cylinder},
                                     {"cones", cone},
                                     {"balls", ball}}) {
      const auto filling = [make = make](bool differ) {
        return [=](CostWorld& world, int count) { fillRows(world, {make, true, differ}, count); };
      };
      scenes.push_back({"different_" + name + "_" + std::to_string(bodies), bodies, 30,
                        filling(true), false, filling(false)});
    }
  return scenes;
}

namespace {

struct Barges {
  const char* name;
  bool has_holds;
  double water;  ///< in each hold [m^3]
};
constexpr Barges kBarges[] = {
    {"barges_closed", false, 0}, {"barges_dry", true, 0}, {"barges_with_water", true, 0.2}};

// Barges in rows that roll a little in still water.
void fillBarges(CostWorld& world, const Barges& barges, int count) {
  constexpr double kMass = 200, kCentre = -0.12;  // [kg]; height in the closed box [m]
  const OpenBarge barge;
  const Vector3 half = barge.size / 2, moments = kMass * Vector3(0.13, 0.42, 0.5);
  const auto shape = std::make_shared<btBoxShape>(vectorOf(half.x(), half.y(), half.z()));
  for (int i = 0; i < count; ++i) {
    const btQuaternion turned(btVector3(1, 0, 0),
                              btScalar(0.02) + btScalar(0.001) * btScalar(i % 11));
    world.addBody(
        shape, kMass, vectorOf(moments.x(), moments.y(), moments.z()),
        btTransform(turned, vectorOf(4 * (i % 32), 4 * (i / 32), 0.03 - barges.water / 2)));
  }
  world.has_surface = true;
  world.attach = [=](Fluid& fluid, const std::vector<std::unique_ptr<btRigidBody>>& bodies) {
    AttachDef def;
    FluidBody body = openBarge(barge);
    if (!barges.has_holds) body.holds.clear();
    if (barges.water > 0) def.holds.water = {barges.water};
    def.fluid_body = std::make_shared<FluidBody>(std::move(body));
    def.fluid_frame.translation = Vector3(0, 0, -kCentre);
    for (const auto& one : bodies) fluid.add(*one, def);
  };
}

}  // namespace

std::vector<CostScene> vesselScenes() {
  std::vector<CostScene> scenes;
  for (const Barges& barges : kBarges)
    scenes.push_back({barges.name, 1000, 30, [&barges](CostWorld& world, int count) {
                        fillBarges(world, barges, count);
                      }});
  return scenes;
}

namespace {

// Boxes in a row that grow and shrink.
void fillScaled(CostWorld& world, int count) {
  for (int i = 0; i < count; ++i)
    world.add(box(1), kDensity, btTransform(btQuaternion::getIdentity(), vectorOf(4 * i, 0, -50)));
  world.attach = [&world](Fluid& fluid, const std::vector<std::unique_ptr<btRigidBody>>& bodies) {
    CollisionShapeSettings settings;
    settings.faces = 1300;
    AttachDef def;
    def.fluid_body = std::make_shared<FluidBody>(makeFluidBody(*box(1), settings));
    def.medium = water();
    std::vector<Immersed> members;
    for (const auto& body : bodies) members.push_back(fluid.add(*body, def));
    world.each_step = [members, shape = def.fluid_body, step = 0]() mutable {
      const double factor = 1 + 0.01 * (++step % 7);
      for (const Immersed& member : members)
        member.setFluidBody(std::make_shared<FluidBody>(scaled(*shape, factor)));
    };
  };
}

}  // namespace

std::vector<CostScene> scaledScenes() { return {{"scaled_in_each_step", 4, 30, fillScaled}}; }

namespace {

const Vector3 kSemiAxes(0.3, 0.2, 0.1);
constexpr double kError = 0.01;  // of loads

struct FlockShape {
  const char* scene;
  const char* file;  // empty: without faces
};
constexpr FlockShape kShapes[] = {{"flight_without_faces", ""},
                                  {"flight_with_500_faces", "500.ambient"},
                                  {"flight_with_5120_faces", "5120.ambient"}};

// Bodies that fly past each other and spin.
void fillFlock(CostWorld& world, const std::string& file, int count) {
  const auto sphere = std::make_shared<btSphereShape>(btScalar(0.3));
  for (int i = 0; i < count; ++i) {
    btRigidBody& body =
        world.addBody(sphere, 1, btVector3(btScalar(0.1), btScalar(0.2), btScalar(0.3)),
                      btTransform(btQuaternion::getIdentity(), btVector3(btScalar(10 * i), 0, 0)));
    body.setLinearVelocity({1, 2, 3});
    body.setAngularVelocity({2, btScalar(i % 7), -1});
  }
  world.duration = 1.0 / 240;
  world.attach = [file](Fluid& fluid, const std::vector<std::unique_ptr<btRigidBody>>& bodies) {
    AttachDef def;
    def.fluid_body = std::make_shared<FluidBody>(file.empty() ? facelessEllipsoid(kSemiAxes)
                                                              : readFluidBody(file));
    def.medium = air();
    def.flow.maximum_load_error = kError;
    for (const auto& body : bodies) fluid.add(*body, def);
  };
}

}  // namespace

std::vector<CostScene> flockScenes(const std::string& shapes) {
  std::vector<CostScene> scenes;
  for (const FlockShape& shape : kShapes) {
    const std::filesystem::path file = std::filesystem::path(shapes) / shape.file;
    scenes.push_back({shape.scene, 100, 30,
                      [file = *shape.file ? file.string() : ""](CostWorld& world, int count) {
                        fillFlock(world, file, count);
                      }});
  }
  return scenes;
}

void makeFlockShapes(const std::string& folder) {
  std::filesystem::create_directories(folder);
  FluidBody coarse = latticeEllipsoid(kSemiAxes, 25, 11), fine = meshedEllipsoid(kSemiAxes, 4);
  for (FluidBody* shape : {&coarse, &fine}) {
    if (const auto level = smallestFormLevel(*shape, kError)) shape->form_levels = {*level};
    writeFluidBody(
        *shape, std::filesystem::path(folder) / (std::to_string(shape->faces.size()) + ".ambient"));
  }
}

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
