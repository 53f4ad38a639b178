#include <stdexcept>

#include "bullet_ambient/ambient.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "tests/benchmark/rivals/bullet_world.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::rivals {
namespace {

class AmbientWorld : public BulletWorld {
 public:
  explicit AmbientWorld(const Scene& scene) : BulletWorld(scene), fluid_(world_) {
    fluid_.setReport([](const std::string&) {});  // light bodies are meant
    if (scene.has_surface) fluid_.addRegion(waterBelow(0));
    if (scene.solid.form == Form::kEllipsoid)
      addEllipsoids();
    else
      addBodies();
  }

 private:
  void addBodies() {
    const AttachReport report = fluid_.addAll(shapes_, water());
    if (!report.refused.empty()) throw std::runtime_error(report.refused.front().reason);
  }

  // Closed form of the added mass, no faces: nothing but the ideal flow.
  void addEllipsoids() {
    if (!scene_.is_ideal) throw std::logic_error("an ellipsoid without faces has no drag");
    const auto [a, b, c] = scene_.solid.size;
    AttachDef def{std::make_shared<FluidBody>(test::facelessEllipsoid({a, b, c})), water()};
    def.medium.viscosity = 0;
    for (const auto& body : bodies_) fluid_.add(*body, def);
  }

  FluidBodyCache shapes_;
  Fluid fluid_;
};

std::unique_ptr<World> makeAmbientWorld(const Scene& scene, bool has_fluid) {
  if (has_fluid) return std::make_unique<AmbientWorld>(scene);
  return std::make_unique<BulletWorld>(scene);
}

}  // namespace

Engine ambientEngine() {
  return {"bullet_ambient", AMBIENT_VERSION, "default settings", makeAmbientWorld};
}

}  // namespace ambient::rivals
