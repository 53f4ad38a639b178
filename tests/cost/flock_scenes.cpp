#include <filesystem>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/reduced_loads/form_levels.h"
#include "tests/cost/cost_world.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::test {
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

}  // namespace ambient::test
